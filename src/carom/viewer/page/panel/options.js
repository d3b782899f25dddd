// The display options, set by scripts (configureDebugVisualizer), by the panel and by keys.

/** Numbers of PyBullet's COV_ENABLE_* flags. */
const FLAG = {
  panel: 1,
  shadows: 2,
  wireframe: 3,
  rendering: 7,
  shortcuts: 9,
  picking: 10,
  rgbPreview: 13,
  depthPreview: 14,
  segmentationPreview: 15,
  reflections: 16,
};

/** Number of groups of shapes, sites and tendons, and which of them are seen at first, as in MuJoCo. */
export const GROUPS = 6;
const FIRST_GROUPS = 3;

export class Options {
  constructor() {
    this.panel = true;
    this.shadows = true;
    this.wireframe = false;
    this.rendering = true;
    this.shortcuts = true;
    this.picking = true;
    this.rgbPreview = true;
    this.depthPreview = true;
    this.segmentationPreview = true;
    this.reflections = false;
    this.names = false;
    this.colours = new Map();
    this.grid = true;
    this.frames = false;
    this.bounds = false;
    this.collisions = false;
    this.visuals = true;
    this.transparent = false;
    this.contacts = false;
    this.forces = false;
    this.cones = false;
    this.axes = false;
    this.torques = false;
    this.limits = false;
    this.positions = false;
    this.masses = false;
    this.inertias = false;
    this.constraints = false;
    this.tendons = false;
    this.rays = false;
    this.cameras = false;
    this.linkNames = false;
    this.skeleton = false;
    this.trail = false;
    this.linkColours = false;
    this.depth = false;
    this.jointFrames = false;
    this.siteFrames = false;
    this.inertiaFrames = false;
    this.contactFrames = false;
    this.fileCameras = false;
    for (let group = 0; group < GROUPS; group++) {
      for (const kind of ["shapes", "sites", "tendons"]) this[`${kind}${group}`] = group < FIRST_GROUPS;
    }
    this.yUp = false;
    this.background = null;
    this.lightPosition = [-3, -2.2, 6];
    this.shadowIntensity = 0.85;
    this.shadowResolution = 2048;
    this.shadowWorldSize = null;
    this.received = {};
    /** Increases when the script sets options. */
    this.version = 0;
  }

  /**
   * Whether a shape is drawn: a collision shape, a site, or a visual shape of a group.
   *
   * @param {{collision?: boolean, site?: boolean, group?: number}} shape
   */
  shows({ collision = false, site = false, group = 0 }) {
    if (collision) return this.collisions;
    return this.showsGroup(site ? "sites" : "shapes", group) && (site || (this.visuals && !this.collisions));
  }

  /** Whether a group of shapes, sites or tendons is drawn. */
  showsGroup(kind, group) {
    return this[`${kind}${Math.min(Math.max(group, 0), GROUPS - 1)}`];
  }

  /** What `shows` depends on, as a text. */
  get shownGroups() {
    const groups = [...Array(GROUPS).keys()].flatMap((group) => [this.showsGroup("shapes", group), this.showsGroup("sites", group)]);
    return [this.collisions, this.visuals, ...groups].join();
  }

  /** Whether surfaces are drawn without light, in colours that show links or depth. */
  get flat() {
    return !this.wireframe && (this.linkColours || this.depth);
  }

  /** The data besides poses that the options need. */
  get wants() {
    return {
      collisions: this.collisions,
      contacts: this.contacts || this.forces || this.cones || this.contactFrames,
      joints: this.torques || this.limits || this.positions,
      dynamics: this.masses || this.inertias,
      constraints: this.constraints,
      rays: this.rays,
      tendons: this.tendons,
    };
  }

  /** The colour that a script has given to a link in wireframe, if any. */
  wireColour(body, link) {
    return this.colours.get(`${body},${link}`);
  }

  /** Sets the options that the script has changed; flags changed only by the user stay. */
  take(message) {
    this.version += 1;
    for (const [name, flag] of Object.entries(FLAG)) {
      const value = message.flags?.[flag];
      if (value !== undefined && value !== this.received[name]) this[name] = this.received[name] = value;
    }
    this.colours = new Map((message.colours ?? []).map(([body, link, colour]) => [`${body},${link}`, colour]));
    if (message.names !== undefined) this.names = message.names;
    this.yUp = message.up_axis === 1;
    this.background = message.background ?? null;
    if (message.light_position && message.light_position.some((x) => x !== 0)) {
      this.lightPosition = message.light_position;
    }
    this.shadowIntensity = message.shadow_map_intensity ?? this.shadowIntensity;
    this.shadowResolution = message.shadow_map_resolution ?? this.shadowResolution;
    this.shadowWorldSize = message.shadow_map_world_size ? message.shadow_map_world_size / 2 : null;
  }
}
