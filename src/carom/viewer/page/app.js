// The page: passes each message to the part of the page that shows it, and draws.

import { Beat } from "./beat.js";
import { Bodies } from "./panel/bodies.js";
import { Camera } from "./view/camera.js";
import { Controllers } from "./input/controllers.js";
import { Drawings } from "./view/drawings.js";
import { Floating } from "./layout/floating.js";
import { FullScreen } from "./layout/full_screen.js";
import { Gamepads } from "./input/gamepads.js";
import { Gizmo } from "./panel/gizmo.js";
import { Grasp, pick, pickShapeless } from "./input/picking.js";
import { Handles, Hands } from "./input/handles.js";
import { Help } from "./panel/help.js";
import { History, isRemoval, nameOf } from "./time/history.js";
import { Keys } from "./panel/keys.js";
import { Labels, labelJoints, labelLinks } from "./view/labels.js";
import { Legend } from "./panel/legend.js";
import { Lenses } from "./panel/lenses.js";
import { Memory } from "./memory.js";
import { Options } from "./panel/options.js";
import { OwnPanels } from "./layout/own.js";
import { Overlays } from "./view/overlays.js";
import { Panel } from "./panel/panel.js";
import { Past } from "./time/past.js";
import { Player } from "./time/player.js";
import { Plots } from "./panel/plots.js";
import { Pointer } from "./input/pointer.js";
import { Previews } from "./panel/previews.js";
import { Quality } from "./panel/quality.js";
import { Readings } from "./view/readings.js";
import { rendererFor } from "./view/renderer.js";
import { Saving } from "./time/saving.js";
import { Scene } from "./view/scene.js";
import { Shots } from "./time/shots.js";
import { Simulation } from "./simulation/simulation.js";
import { Timeline } from "./time/timeline.js";
import { TimeWindow } from "./time/window.js";
import { Toggles } from "./panel/toggles.js";
import { trailOf } from "./time/trail.js";
import { Viewpoint } from "./panel/viewpoint.js";
import { Views } from "./layout/views.js";
import { Worlds } from "./layout/worlds.js";
import { FromPage, ToPage } from "./protocol.js";
import { element } from "./elements.js";
import { isSpectator } from "./spectating.js";

/** @import { View } from "./layout/views.js" */
/** @import { Notices } from "./panel/notices.js" */

/** Simulated time after which the camera is no longer moved to show added bodies, only robots that move out of view [s]. */
const SETTLED = 1;
/** Time without a change before the page rests [ms]: by then the picture is as sharp as it gets. */
const REST_MS = 2000;

export class App {
  /**
   * @param {(message: MessageFromPage) => void} send sends a message to the simulation
   * @param {Notices} notices
   */
  constructor(send, notices) {
    this.send = send;
    /** Tells the user something, for a while. */
    this.say = (text) => notices.say(text);
    this.canvas = element("view", HTMLCanvasElement);
    const labels = document.getElementById("labels");
    this.renderer = rendererFor(this.canvas);
    this.scene = new Scene(this.renderer.gl, this.renderer.byProcessor);
    this.scene.textureArrived = () => this.changed();
    this.camera = new Camera();
    this.options = new Options();
    this.memory = new Memory();
    this.readings = new Readings();
    this.history = new History();
    this.past = new Past(this.history, send);
    this.player = new Player(this.history, (header, payload) => this.show(header, payload));
    this.drawings = new Drawings(this.renderer.gl, labels);
    this.labels = new Labels(labels);
    this.handles = new Handles(this.camera, send);
    this.gamepads = new Gamepads(send);
    this.controllers = new Controllers(this.gamepads, notices);
    this.overlays = new Overlays(this.scene, this.options, this.readings, this.handles, this.camera);
    this.floating = new Floating(this.memory);
    this.own = new OwnPanels(send, this.floating);
    this.panel = new Panel(send, this.options, notices, this.own);
    this.fullScreen = new FullScreen(this.memory, () => this.changed());
    this.toggles = new Toggles(this.options, (name) => this.optionSet(name));
    this.part = new TimeWindow(this.history);
    this.player.part = this.part;
    this.timeline = new Timeline(this.player, this.part, send);
    this.plots = new Plots(this.scene, this.history, this.player, this.part, this.memory, () => this.tellWants(), () => this.changed());
    this.part.changed = () => {
      this.timeline.show();
      this.changed();
    };
    this.history.prepended = (frames) => this.plots.takeEarlier(frames);
    this.bodies = new Bodies(this.scene, this.readings, send);
    this.simulation = new Simulation(this, notices);
    this.worlds = new Worlds(this.scene, send);
    this.overlays.worlds = this.worlds;
    this.viewpoint = new Viewpoint(this.camera, this.scene, this.options, this.memory, () => this.cameraMoved());
    this.bodies.cameraCall = () => this.viewpoint.call;
    this.gizmo = new Gizmo(this.viewpoint);
    this.legend = new Legend();
    this.previews = new Previews(this.memory, send);
    this.views = this.makeViews();
    this.lenses = new Lenses(this.views, this.overlays.stage, () => this.changed());
    this.quality = new Quality(this.renderer, this.memory, () => this.changed());
    this.saving = new Saving(this.canvas, this.history, this.player, new Shots(this), () => document.title, () => this.facts(), (text, lasts) => notices.say(text, lasts));
    this.help = new Help();
    this.keys = new Keys(this);
    this.past.changed = () => {
      this.timeline.show();
      this.changed();
    };
    this.overlays.trail = () => trailOf(this.history, this.player.index, this.scene, this.overlays.selection);
    this.bindMouse();
    this.bodies.selectionChanged = (body, link) => this.select(body, link);
    this.bodies.changed = () => this.changed();
    this.saving.changed = () => this.changed();
    this.saving.filming = (filming) => {
      this.renderer.pace.hold(filming);
      if (this.renderer.resize()) this.changed();
    };
    this.answers = this.makeAnswers();
    this.stale = true;
    this.cameraToTell = false;
    /** Number of the picture that the script waits for, null if none; and of the last picture asked for. */
    this.awaited = null;
    this.lastAwaited = 0;
    document.addEventListener("visibilitychange", () => this.tellVisibility());
    for (const section of document.querySelectorAll("details")) {
      section.addEventListener("toggle", () => {
        this.memory.put("sections", { ...this.memory.get("sections"), [section.id]: section.open });
        this.tellWants();
        this.simulation.soon();
      });
    }
    this.startDrawing();
  }

  /** One view at first; what the panel and the pointer do concerns the chosen one. */
  makeViews() {
    return new Views(this.memory, this.camera, {
      changed: () => this.changed(),
      moved: () => this.cameraMoved(),
      fit: (camera) => this.viewpoint.fitAll(camera),
      chosen: (camera) => {
        this.viewpoint.chosen = this.handles.camera = camera;
        if (this.pointer) this.pointer.camera = this.pointer.pinch.camera = this.grasp.camera = camera;
      },
    });
  }

  bindMouse() {
    const pointer = new Pointer(this.canvas, this.camera, this.send, () => this.cameraMoved());
    pointer.hoverChanged = () => this.options.names && this.changed();
    this.grasp = new Grasp(this.scene, this.camera, this.options, this.send);
    if (!isSpectator()) pointer.grasp = new Hands(this.handles, this.grasp);
    pointer.clicked = (x, y) => {
      const { scene, options } = this;
      const { camera } = this.views.at(x, y);
      const found = pickShapeless(scene, camera, x, y) ?? pick(scene, options, camera.eye, camera.ray(x, y));
      const { world, like } = scene.bodies.get(found?.body) ?? {};
      if (world !== undefined && !isSpectator()) this.worlds.choose(world);
      this.bodies.select(like ?? found?.body ?? null, found?.link ?? null);
      if (found) element("bodies", HTMLDetailsElement).open = true;
    };
    pointer.aim = (x, y) => this.views.choose(this.views.at(x, y));
    this.viewpoint.cameras = () => this.views.cameras;
    this.pointer = pointer;
  }

  /**
   * What takes each message: all but the past, and the end of the run, which `Runs` takes.
   *
   * @returns {Omit<Answers, "past" | "ending">}
   */
  makeAnswers() {
    const { scene, drawings, panel, overlays } = this;
    return {
      [ToPage.TITLE]: (header) => {
        panel.showTitle(header);
        if (header.history) this.history.budget = header.history;
        if (this.memory.begin(header.title)) this.recall();
      },
      [ToPage.MESH]: (header, payload) => scene.addMesh(header, payload),
      [ToPage.NO_MESH]: (header) => scene.removeMesh(header),
      [ToPage.TEXTURE]: (header, payload) => scene.addTexture(header, payload),
      [ToPage.NO_TEXTURE]: (header) => scene.removeTexture(header),
      [ToPage.BODY]: (header) => {
        scene.addBody(header);
        this.bodiesChanged();
      },
      [ToPage.NO_BODY]: (header) => {
        scene.removeBody(header);
        this.bodiesChanged();
      },
      [ToPage.DYNAMICS]: (header) => scene.addDynamics(header),
      [ToPage.NO_DYNAMICS]: (header) => scene.removeDynamics(header),
      [ToPage.LAYOUT]: (header) => {
        scene.layout = header;
        this.bodiesChanged();
      },
      [ToPage.NO_LAYOUT]: () => {},
      [ToPage.FRAME]: (header, payload) => this.showFrame(header, payload),
      [ToPage.CONSTRAINTS]: (header) => (overlays.constraints = header.constraints),
      [ToPage.NO_CONSTRAINTS]: () => (overlays.constraints = []),
      [ToPage.STAGE]: (header) => this.takeStage(header),
      [ToPage.NO_STAGE]: () => this.takeStage(null),
      [ToPage.HANDLE]: (header) => this.handles.take(header),
      [ToPage.PYRAMID]: (header) => (overlays.pyramid = header.corners),
      [ToPage.NO_PYRAMID]: () => (overlays.pyramid = []),
      [ToPage.LENS]: (header) => this.lenses.take(header),
      [ToPage.RAYS]: (_, payload) => overlays.takeRays(payload),
      [ToPage.NO_RAYS]: () => overlays.takeRays(new ArrayBuffer(0)),
      [ToPage.PREVIEWS]: (header, payload) => {
        this.previews.take(header, payload);
        this.previews.show(this.options);
      },
      [ToPage.LINE]: (header) => drawings.add(header),
      [ToPage.TEXT]: (header) => drawings.add(header),
      [ToPage.POINTS]: (header, payload) => drawings.add(header, payload),
      [ToPage.NO_ITEM]: (header) => drawings.remove(header),
      [ToPage.SLIDER]: (header) => panel.addSlider(header),
      [ToPage.NO_SLIDER]: (header) => panel.removeSlider(header),
      [ToPage.PANEL]: (header) => this.own.add(header),
      [ToPage.NO_PANEL]: (header) => this.own.remove(header),
      [ToPage.FIELD]: (header) => this.own.takeField(header),
      [ToPage.NO_FIELD]: (header) => this.own.drop(header.field),
      [ToPage.IMAGE]: (header, payload) => this.own.takeImage(header, payload),
      [ToPage.NO_IMAGE]: (header) => this.own.drop(header.image),
      [ToPage.PAUSE]: (header) => panel.showPause(header),
      [ToPage.SPEED]: (header) => panel.showSpeed(header),
      [ToPage.MARK]: (header) => this.timeline.addMark(header),
      [ToPage.NO_MARK]: (header) => this.timeline.removeMark(header),
      [ToPage.CAMERA]: (header) => {
        if (this.viewpoint.take(header)) this.cameraToTell = true;
      },
      [ToPage.WORLDS]: (header) => {
        // The sliders are those of the world that is looked at.
        if (this.worlds.take(header)) this.bodies.build();
      },
      [ToPage.SIMULATION]: (header) => {
        this.simulation.take(header);
        this.tellWants();
      },
      [ToPage.KEYFRAMES]: (header) => this.simulation.keyframes.take(header),
      [ToPage.SETTINGS]: (header) => this.simulation.settings.take(header),
      [ToPage.ARGUMENTS]: (header) => this.simulation.arguments.take(header),
      [ToPage.CONSOLE]: (header) => this.simulation.console.take(header),
      [ToPage.OPTIONS]: (header) => {
        this.options.take(header);
        this.scriptOptions = header;
        if (this.switchesToRecall) this.recallSwitches();
        this.optionsChanged();
      },
    };
  }

  /** Clears the page at the start of a connection: the simulation sends the whole scene again. */
  begin() {
    for (const part of [this.scene, this.drawings, this.panel, this.previews, this.lenses, this.history]) part.clear();
    for (const part of [this.readings, this.overlays, this.handles, this.timeline, this.player]) part.clear();
    for (const part of [this.past, this.part, this.plots, this.simulation, this.worlds, this.own]) part.clear();
    this.bodies.select(null);
    [this.awaited, this.lastAwaited] = [null, 0];
    this.viewpoint.begin();
    this.gamepads.begin();
    this.tellVisibility();
    this.tellSize();
    this.tellWants();
    this.changed();
  }

  /** Adds a message to the history and, unless a past moment is shown, shows it. */
  receive(header, payload) {
    if (header.type === ToPage.PAST) return this.past.take(header, payload);
    this.history.take(header, payload);
    if (header.type === ToPage.FRAME) this.past.meet(header);
    if (header.type === ToPage.FRAME) this.plotFrame(header, payload);
    const name = nameOf(header);
    const fleeting = header.type === ToPage.FRAME || (name !== null && !name.startsWith("slider"));
    if (fleeting && !this.player.live) return;
    if (name !== null) this.player.stageNow(name, isRemoval(header) ? null : this.history.messages.newest(name));
    this.show(header, payload);
    if (header.type === ToPage.FRAME) this.timeline.show();
  }

  show(header, payload) {
    this.answers[header.type]?.(header, payload);
    this.changed();
  }

  /** Makes everything on the GPU anew, in a graphics context that was lost and has come back. */
  refillGraphics() {
    this.renderer = rendererFor(this.canvas);
    this.quality.take(this.renderer.pace);
    this.scene.forgetGraphics();
    this.drawings.forgetGraphics();
    for (const [name, { header, payload }] of this.player.staged) {
      if (/^(mesh|texture|item) /.test(name)) this.show(header, payload);
    }
    this.changed();
  }

  plotFrame(header, payload) {
    this.plots.takeNames(header);
    const newest = this.history.frames.at(-1);
    // The history leaves out frames that are as the last one.
    if (newest.payload === payload) this.plots.take(newest);
  }

  showFrame(header, payload) {
    this.scene.place(header, payload);
    this.readings.take(header, payload);
    this.panel.showTime(header);
    this.overlays.time = header.time;
    if (element("bodies", HTMLDetailsElement).open) this.bodies.show();
    this.simulation.show();
    if (!header.past && header.picture !== undefined && header.picture !== this.lastAwaited) this.awaited = this.lastAwaited = header.picture;
    this.lookAtBodies();
    if (header.time > SETTLED && this.viewpoint.fitted) this.viewpoint.settled = true;
  }

  bodiesChanged() {
    this.plots.offer();
    this.bodies.offer();
    this.simulation.offer();
    this.toggles.offer(this.scene.bodies, !!this.overlays.stage.facts?.tendons);
    if (this.simulation.on || this.simulation.sensors.isOpen) this.tellWants();
  }

  /** Takes lights, sky and cameras of files; tendons are seen at first where files have them, and the grid only without a sky. */
  takeStage(facts) {
    this.overlays.stage.take(facts);
    this.lenses.takeFiles();
    this.toggles.offer(this.scene.bodies, !!facts?.tendons);
    const chosen = this.memory.get("switches") ?? {};
    if (facts?.tendons && !("tendons" in chosen)) this.options.tendons = true;
    // A file that has a sky of its own looks as it says: without the grid of the window.
    if (facts?.sky >= 0 && !("grid" in chosen)) this.options.grid = false;
    this.optionsChanged();
  }

  /** Looks at the whole scene, as at the start of a run. */
  lookAnew() {
    this.bodies.select(null);
    this.viewpoint.begin();
    // Its bodies may be here already, and while it rests no frame follows.
    this.viewpoint.anew = true;
    this.lookAtBodies();
    this.changed();
  }

  /** Moves the cameras of fresh views to where bodies are. */
  lookAtBodies() {
    if (!this.viewpoint.lookAtFirst() && !this.viewpoint.widen()) return;
    this.cameraToTell = true;
    this.views.fitFresh();
  }

  changed() {
    this.stale = true;
    this.beat?.wake();
  }

  select(body, link) {
    this.overlays.selection = body === null ? null : { body, link };
    this.viewpoint.selection = this.overlays.selection;
    for (const camera of this.views.cameras) camera.followed = null;
    this.tellWants();
    this.changed();
  }

  /** The user has set a display option, which is kept for the next run of the script. */
  optionSet(name) {
    this.memory.put("switches", { ...this.memory.get("switches"), [name]: this.options[name] });
    // The script has started: what it sets from now on counts.
    this.switchesToRecall = false;
    this.optionsChanged();
  }

  /** Shows what the browser has kept for the script: folded sections and switches. */
  recall() {
    for (const [id, open] of Object.entries(this.memory.get("sections") ?? {})) {
      const section = document.getElementById(id);
      if (section instanceof HTMLDetailsElement) section.open = open;
    }
    this.quality.recall();
    this.recallSwitches();
    this.previews.recall();
    this.plots.dock.recall();
    this.floating.recall();
    this.views.recall();
    this.fullScreen.recall();
    this.optionsChanged();
  }

  /** Sets the switches that the user has set, over what the script sets when it starts. */
  recallSwitches() {
    const switches = Object.entries(this.memory.get("switches") ?? {});
    for (const [name, on] of switches) if (typeof this.options[name] === "boolean") this.options[name] = on;
    this.switchesToRecall = this.scriptOptions === undefined;
  }

  optionsChanged() {
    for (const camera of this.views.cameras) {
      camera.yUp = this.options.yUp;
      camera.update();
    }
    this.panel.showOptions();
    this.toggles.show();
    this.previews.show(this.options);
    this.tellWants();
    this.changed();
  }

  cameraMoved() {
    this.views.moved();
    // Only the first view is the script's.
    if (this.views.chosen.camera === this.camera) {
      this.viewpoint.undecided = false;
      this.viewpoint.remember();
      this.cameraToTell = true;
    }
    this.changed();
  }

  /** Tells the simulation which data this page needs besides poses. */
  tellWants() {
    if (!this.simulation) return;
    const { wants } = this.options;
    const plotted = this.plots.wants;
    const { selected, link } = this.bodies;
    const listed = this.simulation.wants;
    const joints = wants.joints || listed.joints ? "all" : [...plotted.joints, ...(selected === null ? [] : [selected])];
    const links = [...plotted.links, ...(selected === null ? [] : [[selected, (link ?? 0) - 1]])];
    const dynamics = wants.dynamics || selected !== null;
    this.send({ type: FromPage.WANT, ...wants, dynamics, contacts: wants.contacts || plotted.contacts || listed.contacts, joints, links, sensors: [...plotted.sensors, ...listed.sensors] });
  }

  tellSize() {
    this.send({ type: FromPage.SIZE, width: this.camera.width, height: this.camera.height });
  }

  tellVisibility() {
    this.gamepads.tell();
    this.send({ type: FromPage.VISIBLE, visible: !document.hidden });
  }

  /** Data for a saved replay that are not in the recorded messages: camera and options. */
  facts() {
    return { camera: this.camera.state(), options: this.scriptOptions };
  }

  startDrawing() {
    this.moved = 0;
    this.drawn = false;
    this.last = this.since = performance.now();
    this.frames = 0;
    this.beat = new Beat((now, rested) => {
      this.draw(now, rested);
      return now - this.moved > REST_MS && !this.stale && !this.player.running;
    });
    this.beat.awoken = () => {
      this.frames = 0;
      this.last = this.since = performance.now();
    };
    this.beat.next();
  }

  draw(now, rested) {
    // While the recording is filmed, all time is for the film.
    if (this.saving.rendering) return;
    const passed = now - this.last;
    if (this.drawn) this.renderer.pace.note(passed);
    this.last = now;
    this.drawn = false;
    this.player.tick(passed / 1000);
    this.gamepads.tell();
    if (this.stale) this.moved = now;
    this.renderer.pace.wait(now - this.moved);
    if (this.renderer.resize()) this.changed();
    this.fitCanvas();
    if (this.cameraToTell) {
      this.cameraToTell = false;
      this.send({ type: FromPage.CAMERA, ...this.camera.state(), chosen: !this.viewpoint.undecided });
    }
    this.frames += 1;
    if (now - this.since > 500 && !rested) {
      this.panel.showFps((this.frames * 1000) / (now - this.since));
      this.quality.show();
      [this.frames, this.since] = [0, now];
    }
    if (!this.stale || this.renderer.lost) return;
    this.stale = false;
    if (this.options.rendering) this.drawScene();
    if (this.awaited !== null) this.send({ type: FromPage.DRAWN, picture: this.awaited });
    this.awaited = null;
  }

  fitCanvas() {
    if (!this.arrange()) return;
    this.tellSize();
    this.changed();
  }

  /** Lays the views out in the window; true if that has changed something. */
  arrange() {
    const { clientWidth, clientHeight } = this.canvas;
    return this.views.arrange(clientWidth, clientHeight, () => this.viewpoint.covers);
  }

  drawScene() {
    this.drawn = true;
    const { scene, camera, options, drawings, pointer, views } = this;
    this.viewpoint.follow();
    this.lenses.follow();
    this.lenses.show();
    views.tellLooks();
    const named = options.names && pointer.hovered && !pointer.grasp.busy ? this.underMouse() : null;
    if (views.count > 1) this.renderer.begin();
    this.labels.begin();
    drawings.keepLabels(views.count);
    for (const view of views.all) this.drawView(view, named);
    drawings.showName(scene, named, pointer.hovered);
    this.gizmo.show(views.chosen.camera, options.panel);
    this.legend.show(this.shownScales(), camera.height / (2 * camera.distance));
    this.viewpoint.show();
    this.plots.draw();
  }

  /** Scales of the arrows that are drawn; 0 for those that are not. */
  shownScales() {
    const { options, overlays } = this;
    const { force, torque } = overlays.scales;
    return { force: options.forces || options.cones ? force : 0, torque: options.torques ? torque : 0 };
  }

  /**
   * Draws a view, with its texts.
   *
   * @param {View} view
   * @param {?{body: number, link: number}} named the link under the mouse
   */
  drawView({ camera, number }, named) {
    const { scene, options, drawings, labels, canvas } = this;
    const lines = this.overlays.draw(camera, drawings, this.grasp.line(), named ?? this.grasp.turned);
    const { solids, selected, stage } = this.overlays;
    const { clouds, signs } = drawings;
    this.renderer.draw(scene, camera, options, { stage, lines, solids, selected, clouds, signs }, this.views.part(number, canvas));
    drawings.addLabels(labels, scene, camera, number);
    this.handles.addLabels(labels, camera);
    this.worlds.addLabels(labels, camera);
    if (options.positions) labelJoints(labels, camera, scene, this.readings);
    if (options.linkNames) labelLinks(labels, camera, scene);
    labels.end(camera);
  }

  underMouse() {
    const { scene, options, pointer } = this;
    const [x, y] = pointer.hovered;
    const { camera } = this.views.at(x, y);
    return pickShapeless(scene, camera, x, y) ?? pick(scene, options, camera.eye, camera.ray(x, y));
  }
}
