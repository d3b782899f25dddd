// The messages between page and simulation. Written by `python -m carom.viewer.protocol` from
// src/carom/viewer/protocol, which is where to change them.

/** The run that the page shows: the first message of a connection. */
interface TitleToPage {
  type: "title";
  /** Title of the page. */
  title: string;
  /** Random name of the run. */
  run: string;
  /** Memory for the past [bytes]; 0 for the page's own limit. */
  history: number;
  /** Token of spectators, for the link that they are given. */
  watch?: string;
}

/** The script ends by an exception. */
interface EndingToPage {
  type: "ending";
  /** The last line of the exception. */
  error: string;
}

/** A mesh that shapes use. Payload: Positions (3), normals (3) and texture coordinates (2) of all vertices as floats of four bytes, then the vertices (3) of all triangles as integers of four bytes. */
interface MeshToPage {
  type: "mesh";
  /** Its number. */
  mesh: number;
  /** Number of its vertices. */
  vertices: number;
  /** Number of its triangles. */
  triangles: number;
}

/** A mesh is gone. */
interface NoMeshToPage {
  type: "no mesh";
  /** Its number. */
  mesh: number;
}

/** An image that shapes use. Payload: Red, green and blue of its pixels, a byte each, the bottom row first; or a file. */
interface TextureToPage {
  type: "texture";
  /** Its number. */
  texture: number;
  /** Its width [pixels]. */
  width: number;
  /** Its height [pixels]. */
  height: number;
  /** Its file type, if it is sent as a file. */
  file?: string;
}

/** An image is gone. */
interface NoTextureToPage {
  type: "no texture";
  /** Its number. */
  texture: number;
}

/** A body, without the poses of its links. */
interface BodyToPage {
  type: "body";
  /** Its number. */
  body: number;
  /** Its name. */
  name: string;
  /** Name of its file. */
  file: string | null;
  /** The folder of its file and its name. */
  path: string | null;
  /** Its links, the base first: their frames, and their joints. */
  links: { name: string, position: [number, number, number], orientation: [number, number, number, number], moves: boolean, joint?: string, kind?: string, axis?: [number, number, number], parent?: number, limits?: [number, number], effort?: number, speed?: number }[];
  /** Its shapes, each in the inertial frame of a link, 0 for the base. */
  shapes: { link: number, meshes: [number, number | null][], texture: number, rgba: [number, number, number, number], specular: [number, number, number], twoSided: boolean, position: [number, number, number], orientation: [number, number, number, number], scale: [number, number, number], collision?: boolean, site?: boolean, group?: number, reflectance?: number }[];
  /** Its actuators, and the ranges of their sliders. */
  actuators?: { name: string, range: [number, number] }[];
  /** Its sensors, and how many numbers each gives. */
  sensors?: { name: string, kind: string, size: number }[];
  /** Its sites, each in the inertial frame of a link, 0 for the base. */
  sites?: { name: string, link: number, position: [number, number, number], orientation: [number, number, number, number] }[];
  /** Its world, of many worlds of which another one is chosen. */
  world?: number;
  /** Number of the same body of the chosen world, if it is of another one. */
  like?: number;
}

/** A body is gone. */
interface NoBodyToPage {
  type: "no body";
  /** Its number. */
  body: number;
}

/** Masses of a body. */
interface DynamicsToPage {
  type: "dynamics";
  /** Number of the body. */
  dynamics: number;
  /** The same. */
  body: number;
  /** Mass [kg] and principal moments of inertia [kg m²] of its links, the base first. */
  links: { mass: number, inertia: number[] }[];
}

/** Masses of a body are not told any more. */
interface NoDynamicsToPage {
  type: "no dynamics";
  /** Number of the body. */
  dynamics: number;
}

/** Whose poses frames have, and in which order. */
interface LayoutToPage {
  type: "layout";
  /** Number of the layout, which frames name. */
  layout: number;
  /** Number of each body, and of its links. */
  bodies: [number, number][];
}

/** There is no layout at a moment of the past. */
interface NoLayoutToPage {
  type: "no layout";
}

/** The poses of all links at a time. Payload: Poses (3 for the position, 4 for the orientation) and readings as floats of four bytes. */
interface FrameToPage {
  type: "frame";
  /** Number of the layout of the poses. */
  layout: number;
  /** Number of poses. */
  poses: number;
  /** Simulated time [s]. */
  time: number;
  /** Simulated time / real time; a replay has none. */
  rate?: number;
  /** Number of the picture that the script waits for. */
  picture?: number;
  /** Values that the script plots, by name. */
  values?: Record<string, number>;
  /** Name and number of rows of each array of readings after the poses. */
  blocks?: [string, number][];
  /** Number of the frame in the history of the simulation. */
  number?: number;
  /** Set by the page: whether it is shown as a moment of the past. */
  past?: boolean;
}

/** A part of the past that the page has asked for. Payload: A recording: the other messages, then the frames. */
interface PastToPage {
  type: "past";
  /** Number of its first frame. */
  first: number;
  /** Number of the oldest frame that there is. */
  oldest: number;
  /** Name of each other message in it, and the frames from which and to which it was shown. */
  versions: [string, number, number | null][];
}

/** Constraints of scripts. */
interface ConstraintsToPage {
  type: "constraints";
  /** All of them: number, kind, and the two frames; body -1 is the world. */
  constraints: { constraint: number, kind: string, parent: { body: number, link: number, position: [number, number, number] }, child: { body: number, link: number, position: [number, number, number] } }[];
}

/** No constraints are told at a moment of the past. */
interface NoConstraintsToPage {
  type: "no constraints";
}

/** Lights, sky and cameras of files, each in the frame of a link, 0 for the base; body -1 is the world. */
interface StageToPage {
  type: "stage";
  /** Number of the texture of the cube around everything; -1 for none. */
  sky: number;
  /** Colour of the horizon. */
  haze: [number, number, number];
  /** The light at the viewer. */
  headlight: { ambient: [number, number, number], diffuse: [number, number, number], specular: [number, number, number] } | null;
  /** The other lights: angles [degrees], and at what link each is aimed. */
  lights: { body: number, link: number, position: [number, number, number], direction: [number, number, number], directional: boolean, cutoff: number, exponent: number, attenuation: [number, number, number], ambient: [number, number, number], diffuse: [number, number, number], specular: [number, number, number], shadow: boolean, target?: [number, number] }[];
  /** The cameras: vertical angle [degrees], and width by height. */
  cameras: { body: number, link: number, position: [number, number, number], name: string, orientation: [number, number, number, number], angle: number, aspect: number, target?: [number, number] }[];
  /** Whether tendons are seen at first. */
  tendons: boolean;
}

/** No file says how the scene is seen. */
interface NoStageToPage {
  type: "no stage";
}

/** A frame that the user can move. */
interface HandleToPage {
  type: "handle";
  /** Its number. */
  handle: number;
  /** Its label. */
  name: string;
  /** Its position in the world [m]. */
  position: [number, number, number];
  /** Its orientation (x, y, z, w). */
  orientation: [number, number, number, number];
}

/** Where the camera of the script's last image was. */
interface PyramidToPage {
  type: "pyramid";
  /** Corners of its frustum in the world [m]: four near, four far. */
  corners: [number, number, number][];
}

/** The script has no image at a moment of the past. */
interface NoPyramidToPage {
  type: "no pyramid";
}

/** A camera that the page can look through. */
interface LensToPage {
  type: "lens";
  /** Its number. */
  lens: number;
  /** Its name. */
  name: string;
  /** Columns of its image. */
  width: number;
  /** Rows of its image. */
  height: number;
  /** From the world to the eye, by columns. */
  view: number[];
  /** From the eye to clip coordinates, by columns. */
  projection: number[];
}

/** The last rays that the script has cast. Payload: Start (3), end (3), normal at the hit (3) and fraction of each ray as floats of four bytes. */
interface RaysToPage {
  type: "rays";
  /** Number of rays. */
  count: number;
}

/** No rays are told at a moment of the past. */
interface NoRaysToPage {
  type: "no rays";
}

/** The script's last image. Payload: Red, green and blue, a byte each, of its colours, its depth and its segmentation. */
interface PreviewsToPage {
  type: "previews";
  /** Width [pixels]. */
  width: number;
  /** Height [pixels]. */
  height: number;
}

/** A line that the script draws. */
interface LineToPage {
  type: "line";
  /** Number of the drawing. */
  item: number;
  /** Number of the body that the drawing is fixed to; -1 for the world. */
  body: number;
  /** Link of that body, 0 for its base. */
  link: number;
  /** Start [m]. */
  start: [number, number, number];
  /** End [m]. */
  end: [number, number, number];
  /** Red, green and blue, from 0 to 1. */
  colour: [number, number, number];
  /** Width [pixels]. */
  width: number;
}

/** A text that the script draws. */
interface TextToPage {
  type: "text";
  /** Number of the drawing. */
  item: number;
  /** Number of the body that the drawing is fixed to; -1 for the world. */
  body: number;
  /** Link of that body, 0 for its base. */
  link: number;
  /** The text. */
  text: string;
  /** Where it is [m]. */
  position: [number, number, number];
  /** Red, green and blue, from 0 to 1. */
  colour: [number, number, number];
  /** Size of the letters, relative to the usual one. */
  size: number;
  /** Its orientation (x, y, z, w); null if it faces the camera. */
  orientation: [number, number, number, number] | null;
}

/** Points that the script draws. Payload: Positions (3) of all points, then their colours (3), as floats of four bytes. */
interface PointsToPage {
  type: "points";
  /** Number of the drawing. */
  item: number;
  /** Number of the body that the drawing is fixed to; -1 for the world. */
  body: number;
  /** Link of that body, 0 for its base. */
  link: number;
  /** Size of each [pixels]. */
  size: number;
  /** Number of points. */
  count: number;
}

/** A drawing is gone. */
interface NoItemToPage {
  type: "no item";
  /** Number of the drawing. */
  item: number;
}

/** A control of the panel: a slider, a button, a list of texts or a checkbox. */
interface SliderToPage {
  type: "slider";
  /** Its number. */
  slider: number;
  /** Its label. */
  name: string;
  /** Whether it is a button. */
  button: boolean;
  /** Its least value. */
  lower: number;
  /** Its greatest value. */
  upper: number;
  /** Its value; of a button the number of clicks. */
  value: number;
  /** The texts of a list; none for a checkbox. */
  options?: string[];
  /** Number of the script's own panel that it is in. */
  panel?: number;
}

/** A panel of the script. */
interface PanelToPage {
  type: "panel";
  /** Its number. */
  panel: number;
  /** Its title. */
  title: string;
}

/** A panel of the script is gone. */
interface NoPanelToPage {
  type: "no panel";
  /** Its number. */
  panel: number;
}

/** A text of the panel. */
interface FieldToPage {
  type: "field";
  /** Its number, among those of controls. */
  field: number;
  /** Its label. */
  name: string;
  /** The text. */
  text: string;
  /** Whether users can type. */
  editable: boolean;
  /** Number of the script's own panel that it is in. */
  panel?: number;
}

/** A text is gone. */
interface NoFieldToPage {
  type: "no field";
  /** Its number. */
  field: number;
}

/** An image of the panel. Payload: The image as a PNG file. */
interface ImageToPage {
  type: "image";
  /** Its number, among those of controls. */
  image: number;
  /** Its label. */
  name: string;
  /** Its width [pixels]. */
  width: number;
  /** Its height [pixels]. */
  height: number;
  /** Number of the script's own panel that it is in. */
  panel?: number;
}

/** An image is gone. */
interface NoImageToPage {
  type: "no image";
  /** Its number. */
  image: number;
}

/** A control is gone. */
interface NoSliderToPage {
  type: "no slider";
  /** Its number. */
  slider: number;
}

/** Whether the simulation is paused. */
interface PauseToPage {
  type: "pause";
  /** Whether it is. */
  paused: boolean;
}

/** The limit of the speed. */
interface SpeedToPage {
  type: "speed";
  /** Simulated time / real time; null for no limit. */
  speed: number | null;
}

/** A state that the user has marked. */
interface MarkToPage {
  type: "mark";
  /** Its number. */
  mark: number;
  /** Simulated time [s]. */
  time: number;
}

/** A mark is gone. */
interface NoMarkToPage {
  type: "no mark";
  /** Its number. */
  mark: number;
}

/** The view: set by the script, or that of another page. */
interface CameraToPage {
  type: "camera";
  /** Distance of the eye from the target [m]. */
  distance: number;
  /** Angle about the upward axis [degrees]. */
  yaw: number;
  /** Upward angle [degrees]; negative when the camera looks down. */
  pitch: number;
  /** The point that the camera looks at [m]. */
  target: [number, number, number];
  /** Whether a script or a user has set it. */
  chosen: boolean;
  /** Whether it was the script. */
  script: boolean;
}

/** The display options of the script. */
interface OptionsToPage {
  type: "options";
  /** PyBullet's flags, by their `COV_*` numbers. */
  flags?: Record<string, boolean>;
  /** Whether the body under the mouse is named. */
  names?: boolean;
  /** Colour in wireframe of links: body, link (0 for the base), colour. */
  colours?: [number, number, [number, number, number]][];
  /** 1 if y points up, else 2. */
  up_axis?: number;
  /** Colour of the background. */
  background?: [number, number, number] | null;
  /** Where the light is [m]. */
  light_position?: [number, number, number] | null;
  /** How bright shadows are, from 0 to 1. */
  shadow_map_intensity?: number | null;
  /** Side of the shadow map [pixels]. */
  shadow_map_resolution?: number | null;
  /** Side of the area with shadows [m]. */
  shadow_map_world_size?: number | null;
  /** Not used by the page. */
  remote_sync_transform_interval?: number | null;
}

/** Which of many worlds are shown; bodies of the chosen one have their own numbers. */
interface WorldsToPage {
  type: "worlds";
  /** How many there are. */
  count: number;
  /** Those that are shown. */
  shown: number[];
  /** The one that is looked at. */
  chosen: number;
  /** grid: side by side; overlay: all in one place. */
  arrangement: string;
  /** The middle of the place of each [m]. */
  cells: [number, number, number][];
  /** Side of these places [m]; 0 if all are in one place. */
  size: number;
}

/** What a simulation without a script shows; its page has sections that others have not. */
interface SimulationToPage {
  type: "simulation";
  /** Names of its files. */
  files: string[];
  /** What the files state besides bodies: name, value. */
  stated: [string, string][];
}

/** The keyframes of a simulation without a script. */
interface KeyframesToPage {
  type: "keyframes";
  /** Name, simulated time [s] and text to copy of each, and whether the user has saved it. */
  keyframes: { name: string, time: number, text: string, own: boolean }[];
}

/** The parameters of a simulation that its user can change. */
interface SettingsToPage {
  type: "settings";
  /** Numbers, switches and choices, with their present values. */
  settings: { name: string, title: string, value: number[] | boolean | string, unit?: string, choices?: string[] }[];
}

/** The arguments that xacro files declare. */
interface ArgumentsToPage {
  type: "arguments";
  /** Their names and values. */
  arguments: { name: string, value: string }[];
}

/** Warnings and errors, and what of the files is not simulated. */
interface ConsoleToPage {
  type: "console";
  /** Level (info, ignored, warning or error), text, and how often it was said in turn. */
  lines: { level: string, text: string, count: number }[];
}

type MessageToPage =
  | TitleToPage
  | EndingToPage
  | MeshToPage
  | NoMeshToPage
  | TextureToPage
  | NoTextureToPage
  | BodyToPage
  | NoBodyToPage
  | DynamicsToPage
  | NoDynamicsToPage
  | LayoutToPage
  | NoLayoutToPage
  | FrameToPage
  | PastToPage
  | ConstraintsToPage
  | NoConstraintsToPage
  | StageToPage
  | NoStageToPage
  | HandleToPage
  | PyramidToPage
  | NoPyramidToPage
  | LensToPage
  | RaysToPage
  | NoRaysToPage
  | PreviewsToPage
  | LineToPage
  | TextToPage
  | PointsToPage
  | NoItemToPage
  | SliderToPage
  | PanelToPage
  | NoPanelToPage
  | FieldToPage
  | NoFieldToPage
  | ImageToPage
  | NoImageToPage
  | NoSliderToPage
  | PauseToPage
  | SpeedToPage
  | MarkToPage
  | NoMarkToPage
  | CameraToPage
  | OptionsToPage
  | WorldsToPage
  | SimulationToPage
  | KeyframesToPage
  | SettingsToPage
  | ArgumentsToPage
  | ConsoleToPage;

/** The user has moved a slider, or chosen from a list. */
interface SliderFromPage {
  type: "slider";
  /** Number of the slider. From 0 to 9007199254740991. */
  slider: number;
  /** Its new value. From -1.7976931348623157e+308 to 1.7976931348623157e+308. */
  value: number;
}

/** The user has clicked a button. */
interface PressFromPage {
  type: "press";
  /** Number of the button. From 0 to 9007199254740991. */
  slider: number;
}

/** The user has typed a text. */
interface FieldFromPage {
  type: "field";
  /** Number of the text. From 0 to 9007199254740991. */
  field: number;
  /** The new text. */
  text: string;
}

/** The user has pressed or released a key. */
interface KeyFromPage {
  type: "key";
  /** What the key writes, as in `KeyboardEvent.key`. */
  key: string;
  /** Which key it is, as in `KeyboardEvent.code`. */
  code: string;
  /** Whether it is pressed. */
  down: boolean;
}

/** The page has lost the keyboard: all its keys are released. */
interface BlurFromPage {
  type: "blur";
}

/** The mouse has moved or, with a button, a button has been pressed or released. */
interface MouseFromPage {
  type: "mouse";
  /** Pixels from the left edge of the view. From -1e+06 to 1e+06. */
  x: number;
  /** Pixels from its upper edge. From -1e+06 to 1e+06. */
  y: number;
  /** 0 for the left button, 1 for the middle one, 2 for the right one. From -1 to 31. */
  button?: number;
  /** Whether the button is pressed. */
  down?: boolean;
}

/** The view of the page has changed. */
interface CameraFromPage {
  type: "camera";
  /** Distance of the eye from the target [m]. From 1e-06 to 1e+09. */
  distance: number;
  /** Angle about the upward axis [degrees]. From -1e+09 to 1e+09. */
  yaw: number;
  /** Upward angle [degrees]; negative when the camera looks down. From -1e+09 to 1e+09. */
  pitch: number;
  /** The point that the camera looks at [m]. From -1e+09 to 1e+09. */
  target: [number, number, number];
  /** Whether the user has set the view, and not the page itself. */
  chosen?: boolean;
}

/** The size of the view. */
interface SizeFromPage {
  type: "size";
  /** Width [pixels]. From 0 to 65536. */
  width: number;
  /** Height [pixels]. From 0 to 65536. */
  height: number;
}

/** The page has come into view, or has gone out of it. */
interface VisibleFromPage {
  type: "visible";
  /** Whether it is in view. */
  visible: boolean;
}

/** The page has drawn a picture that the script waits for. */
interface DrawnFromPage {
  type: "drawn";
  /** The number of the picture, from the frame. From 0 to 9007199254740991. */
  picture: number;
}

/** The page asks for frames of the past. */
interface PastFromPage {
  type: "past";
  /** Number of the frame before which they are. From 0 to 9007199254740991. */
  before: number;
  /** Whether the page knows what was shown with that frame. */
  known: boolean;
}

/** The width of previews that the page needs. */
interface PreviewWidthFromPage {
  type: "preview width";
  /** Width [pixels]. From 0 to 65536. */
  width: number;
}

/** The data besides poses that the page needs. */
interface WantFromPage {
  type: "want";
  /** Collision shapes. */
  collisions?: boolean;
  /** Contacts and their forces. */
  contacts?: boolean;
  /** Bodies whose joints are read, or all of them. From 0 to 9007199254740991. */
  joints?: "all" | number[];
  /** Bodies and links whose velocities are read. From -1 to 9007199254740991. */
  links?: [number, number][];
  /** Masses and inertias. */
  dynamics?: boolean;
  /** Constraints of scripts. */
  constraints?: boolean;
  /** Rays that scripts cast. */
  rays?: boolean;
  /** Bodies whose sensors are read. From 0 to 9007199254740991. */
  sensors?: number[];
  /** Paths of tendons. */
  tendons?: boolean;
}

/** The user drives a joint. */
interface DriveFromPage {
  type: "drive";
  /** Number of the body. From 0 to 9007199254740991. */
  body: number;
  /** Number of the joint. From 0 to 9007199254740991. */
  joint: number;
  /** What the target is; a position if missing. */
  mode?: "position" | "velocity" | "torque";
  /** Target in units of the mode [m or rad, m/s or rad/s, N or N m]. From -1e+06 to 1e+06. */
  target: number;
}

/** The user sets the control of an actuator. */
interface ControlFromPage {
  type: "control";
  /** Number of the body. From 0 to 9007199254740991. */
  body: number;
  /** Number of the actuator among those of the body. From 0 to 9007199254740991. */
  actuator: number;
  /** Its control. From -1e+06 to 1e+06. */
  control: number;
}

/** The user gives a joint back to the script. */
interface GiveBackFromPage {
  type: "give back";
  /** Number of the body. From 0 to 9007199254740991. */
  body: number;
  /** Number of the joint. From 0 to 9007199254740991. */
  joint: number;
}

/** The user has moved a handle. */
interface HandleFromPage {
  type: "handle";
  /** Number of the handle. From 0 to 9007199254740991. */
  handle: number;
  /** Its new position in the world [m]. From -1e+09 to 1e+09. */
  position: [number, number, number];
  /** Its new orientation (x, y, z, w). From -2 to 2. */
  orientation: [number, number, number, number];
}

/** The user lets bodies sleep, or wakes them. */
interface SleepFromPage {
  type: "sleep";
}

/** The user starts or ends a timing profile. */
interface ProfileFromPage {
  type: "profile";
  /** Whether it starts. */
  running: boolean;
}

/** The user has grabbed a body at a point. */
interface GraspFromPage {
  type: "grasp";
  /** Number of the body. From 0 to 9007199254740991. */
  body: number;
  /** Link of the body, -1 for its base. From -1 to 9007199254740991. */
  link: number;
  /** The point in the inertial frame of the link [m]. From -1e+09 to 1e+09. */
  point: [number, number, number];
  /** Where it is to be, in the world [m]. From -1e+09 to 1e+09. */
  target: [number, number, number];
}

/** The user pulls what is grabbed. */
interface PullFromPage {
  type: "pull";
  /** Where the grabbed point is to be, in the world [m]. From -1e+09 to 1e+09. */
  target: [number, number, number];
}

/** The user turns a body. */
interface TurnFromPage {
  type: "turn";
  /** Number of the body. From 0 to 9007199254740991. */
  body: number;
  /** Link of the body, -1 for its base. From -1 to 9007199254740991. */
  link: number;
  /** Orientation that its inertial frame is to have (x, y, z, w). From -2 to 2. */
  orientation: [number, number, number, number];
}

/** The user lets go of what is pulled or turned. */
interface LetGoFromPage {
  type: "let go";
}

/** The state of the gamepads at the page's machine. */
interface GamepadsFromPage {
  type: "gamepads";
  /** All of them: see `Gamepad`. From -10 to 10. */
  gamepads: { name: string, axes: number[], buttons: number[], standard: boolean }[];
}

/** The user pauses the simulation, or continues it. */
interface PauseFromPage {
  type: "pause";
  /** Whether to pause. */
  paused: boolean;
}

/** The user lets a paused simulation make a step. */
interface StepFromPage {
  type: "step";
}

/** The user limits the speed. */
interface SpeedFromPage {
  type: "speed";
  /** Simulated time / real time; null for no limit. From 0.0001 to 10000. */
  speed: number | null;
}

/** The user goes back to the start state. */
interface ResetFromPage {
  type: "reset";
}

/** The user marks the present state. */
interface MarkFromPage {
  type: "mark";
}

/** The user goes back to a mark. */
interface RestoreFromPage {
  type: "restore";
  /** The number of the mark. From 0 to 9007199254740991. */
  mark: number;
}

/** The user chooses which of many worlds are shown. */
interface WorldsFromPage {
  type: "worlds";
  /** The one to look at. From 0 to 9007199254740991. */
  chosen?: number;
  /** How many are shown. From 1 to 256. */
  shown?: number;
  /** Side by side, or all in one place. */
  arrangement?: "grid" | "overlay";
}

/** The user ends the script's viewer. */
interface CloseFromPage {
  type: "close";
}

/** The user goes to a keyframe, keeps the present state as one, or drops one that was kept so. */
interface KeyframeFromPage {
  type: "keyframe";
  /** What is done. */
  action: "reset" | "save" | "forget";
  /** Name of the keyframe. */
  name: string;
}

/** The user changes a parameter of the simulation. */
interface SettingFromPage {
  type: "setting";
  /** Its name, from the settings that the page was told. */
  name: string;
  /** Its new value. From -1e+09 to 1e+09. */
  value: number[] | boolean | string;
}

/** The user gives a xacro file other arguments, with which it is loaded again. */
interface ArgumentsFromPage {
  type: "arguments";
  /** Their values, by name. */
  values: Record<string, string>;
}

/** The user loads the files again. */
interface ReloadFromPage {
  type: "reload";
}

/** A piece of a file that the user has dropped on the page. */
interface UploadFromPage {
  type: "upload";
  /** Its path among what was dropped, with slashes. */
  name: string;
  /** Whether it is the first piece of the file. */
  start: boolean;
  /** Its bytes, in base 64. */
  data: string;
}

/** All that the user has dropped has been sent: it is shown instead of what there is. */
interface OpenFromPage {
  type: "open";
}

type MessageFromPage =
  | SliderFromPage
  | PressFromPage
  | FieldFromPage
  | KeyFromPage
  | BlurFromPage
  | MouseFromPage
  | CameraFromPage
  | SizeFromPage
  | VisibleFromPage
  | DrawnFromPage
  | PastFromPage
  | PreviewWidthFromPage
  | WantFromPage
  | DriveFromPage
  | ControlFromPage
  | GiveBackFromPage
  | HandleFromPage
  | SleepFromPage
  | ProfileFromPage
  | GraspFromPage
  | PullFromPage
  | TurnFromPage
  | LetGoFromPage
  | GamepadsFromPage
  | PauseFromPage
  | StepFromPage
  | SpeedFromPage
  | ResetFromPage
  | MarkFromPage
  | RestoreFromPage
  | WorldsFromPage
  | CloseFromPage
  | KeyframeFromPage
  | SettingFromPage
  | ArgumentsFromPage
  | ReloadFromPage
  | UploadFromPage
  | OpenFromPage;

/** What takes each message to the page. */
type Answers = {
  [Type in MessageToPage["type"]]: (
    header: Extract<MessageToPage, { type: Type }>,
    payload: ArrayBuffer,
  ) => void;
};
