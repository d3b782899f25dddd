// Types and bounds of the messages between page and simulation. Written by `python -m carom.viewer.protocol` from
// src/carom/viewer/protocol, which is where to change them.

/** Types of the messages to the page. */
export const ToPage = Object.freeze(/** @type {const} */ ({
  /** The run that the page shows: the first message of a connection. */
  TITLE: "title",
  /** The script ends by an exception. */
  ENDING: "ending",
  /** A mesh that shapes use. */
  MESH: "mesh",
  /** A mesh is gone. */
  NO_MESH: "no mesh",
  /** An image that shapes use. */
  TEXTURE: "texture",
  /** An image is gone. */
  NO_TEXTURE: "no texture",
  /** A body, without the poses of its links. */
  BODY: "body",
  /** A body is gone. */
  NO_BODY: "no body",
  /** Masses of a body. */
  DYNAMICS: "dynamics",
  /** Masses of a body are not told any more. */
  NO_DYNAMICS: "no dynamics",
  /** Whose poses frames have, and in which order. */
  LAYOUT: "layout",
  /** There is no layout at a moment of the past. */
  NO_LAYOUT: "no layout",
  /** The poses of all links at a time. */
  FRAME: "frame",
  /** A part of the past that the page has asked for. */
  PAST: "past",
  /** Constraints of scripts. */
  CONSTRAINTS: "constraints",
  /** No constraints are told at a moment of the past. */
  NO_CONSTRAINTS: "no constraints",
  /** Lights, sky and cameras of files, each in the frame of a link, 0 for the base; body -1 is the world. */
  STAGE: "stage",
  /** No file says how the scene is seen. */
  NO_STAGE: "no stage",
  /** A frame that the user can move. */
  HANDLE: "handle",
  /** Where the camera of the script's last image was. */
  PYRAMID: "pyramid",
  /** The script has no image at a moment of the past. */
  NO_PYRAMID: "no pyramid",
  /** A camera that the page can look through. */
  LENS: "lens",
  /** The last rays that the script has cast. */
  RAYS: "rays",
  /** No rays are told at a moment of the past. */
  NO_RAYS: "no rays",
  /** The script's last image. */
  PREVIEWS: "previews",
  /** A line that the script draws. */
  LINE: "line",
  /** A text that the script draws. */
  TEXT: "text",
  /** Points that the script draws. */
  POINTS: "points",
  /** A drawing is gone. */
  NO_ITEM: "no item",
  /** A control of the panel: a slider, a button, a list of texts or a checkbox. */
  SLIDER: "slider",
  /** A panel of the script. */
  PANEL: "panel",
  /** A panel of the script is gone. */
  NO_PANEL: "no panel",
  /** A text of the panel. */
  FIELD: "field",
  /** A text is gone. */
  NO_FIELD: "no field",
  /** An image of the panel. */
  IMAGE: "image",
  /** An image is gone. */
  NO_IMAGE: "no image",
  /** A control is gone. */
  NO_SLIDER: "no slider",
  /** Whether the simulation is paused. */
  PAUSE: "pause",
  /** The limit of the speed. */
  SPEED: "speed",
  /** A state that the user has marked. */
  MARK: "mark",
  /** A mark is gone. */
  NO_MARK: "no mark",
  /** The view: set by the script, or that of another page. */
  CAMERA: "camera",
  /** The display options of the script. */
  OPTIONS: "options",
  /** Which of many worlds are shown; bodies of the chosen one have their own numbers. */
  WORLDS: "worlds",
  /** What a simulation without a script shows; its page has sections that others have not. */
  SIMULATION: "simulation",
  /** The keyframes of a simulation without a script. */
  KEYFRAMES: "keyframes",
  /** The parameters of a simulation that its user can change. */
  SETTINGS: "settings",
  /** The arguments that xacro files declare. */
  ARGUMENTS: "arguments",
  /** Warnings and errors, and what of the files is not simulated. */
  CONSOLE: "console",
}));

/** Types of the messages from the page. */
export const FromPage = Object.freeze(/** @type {const} */ ({
  /** The user has moved a slider, or chosen from a list. */
  SLIDER: "slider",
  /** The user has clicked a button. */
  PRESS: "press",
  /** The user has typed a text. */
  FIELD: "field",
  /** The user has pressed or released a key. */
  KEY: "key",
  /** The page has lost the keyboard: all its keys are released. */
  BLUR: "blur",
  /** The mouse has moved or, with a button, a button has been pressed or released. */
  MOUSE: "mouse",
  /** The view of the page has changed. */
  CAMERA: "camera",
  /** The size of the view. */
  SIZE: "size",
  /** The page has come into view, or has gone out of it. */
  VISIBLE: "visible",
  /** The page has drawn a picture that the script waits for. */
  DRAWN: "drawn",
  /** The page asks for frames of the past. */
  PAST: "past",
  /** The width of previews that the page needs. */
  PREVIEW_WIDTH: "preview width",
  /** The data besides poses that the page needs. */
  WANT: "want",
  /** The user drives a joint. */
  DRIVE: "drive",
  /** The user sets the control of an actuator. */
  CONTROL: "control",
  /** The user gives a joint back to the script. */
  GIVE_BACK: "give back",
  /** The user has moved a handle. */
  HANDLE: "handle",
  /** The user lets bodies sleep, or wakes them. */
  SLEEP: "sleep",
  /** The user starts or ends a timing profile. */
  PROFILE: "profile",
  /** The user has grabbed a body at a point. */
  GRASP: "grasp",
  /** The user pulls what is grabbed. */
  PULL: "pull",
  /** The user turns a body. */
  TURN: "turn",
  /** The user lets go of what is pulled or turned. */
  LET_GO: "let go",
  /** The state of the gamepads at the page's machine. */
  GAMEPADS: "gamepads",
  /** The user pauses the simulation, or continues it. */
  PAUSE: "pause",
  /** The user lets a paused simulation make a step. */
  STEP: "step",
  /** The user limits the speed. */
  SPEED: "speed",
  /** The user goes back to the start state. */
  RESET: "reset",
  /** The user marks the present state. */
  MARK: "mark",
  /** The user goes back to a mark. */
  RESTORE: "restore",
  /** The user chooses which of many worlds are shown. */
  WORLDS: "worlds",
  /** The user ends the script's viewer. */
  CLOSE: "close",
  /** The user goes to a keyframe, keeps the present state as one, or drops one that was kept so. */
  KEYFRAME: "keyframe",
  /** The user changes a parameter of the simulation. */
  SETTING: "setting",
  /** The user gives a xacro file other arguments, with which it is loaded again. */
  ARGUMENTS: "arguments",
  /** The user loads the files again. */
  RELOAD: "reload",
  /** A piece of a file that the user has dropped on the page. */
  UPLOAD: "upload",
  /** All that the user has dropped has been sent: it is shown instead of what there is. */
  OPEN: "open",
}));

/**
 * Least and greatest value of the numbers in the fields of messages from the page.
 *
 * @type {Readonly<Record<string, Readonly<Record<string, [number, number]>>>>}
 */
export const BOUNDS = Object.freeze({
  [FromPage.SLIDER]: { slider: [0, 9007199254740991], value: [-1.7976931348623157e+308, 1.7976931348623157e+308] },
  [FromPage.PRESS]: { slider: [0, 9007199254740991] },
  [FromPage.FIELD]: { field: [0, 9007199254740991] },
  [FromPage.MOUSE]: { x: [-1e+06, 1e+06], y: [-1e+06, 1e+06], button: [-1, 31] },
  [FromPage.CAMERA]: { distance: [1e-06, 1e+09], yaw: [-1e+09, 1e+09], pitch: [-1e+09, 1e+09], target: [-1e+09, 1e+09] },
  [FromPage.SIZE]: { width: [0, 65536], height: [0, 65536] },
  [FromPage.DRAWN]: { picture: [0, 9007199254740991] },
  [FromPage.PAST]: { before: [0, 9007199254740991] },
  [FromPage.PREVIEW_WIDTH]: { width: [0, 65536] },
  [FromPage.WANT]: { joints: [0, 9007199254740991], links: [-1, 9007199254740991], sensors: [0, 9007199254740991] },
  [FromPage.DRIVE]: { body: [0, 9007199254740991], joint: [0, 9007199254740991], target: [-1e+06, 1e+06] },
  [FromPage.CONTROL]: { body: [0, 9007199254740991], actuator: [0, 9007199254740991], control: [-1e+06, 1e+06] },
  [FromPage.GIVE_BACK]: { body: [0, 9007199254740991], joint: [0, 9007199254740991] },
  [FromPage.HANDLE]: { handle: [0, 9007199254740991], position: [-1e+09, 1e+09], orientation: [-2, 2] },
  [FromPage.GRASP]: { body: [0, 9007199254740991], link: [-1, 9007199254740991], point: [-1e+09, 1e+09], target: [-1e+09, 1e+09] },
  [FromPage.PULL]: { target: [-1e+09, 1e+09] },
  [FromPage.TURN]: { body: [0, 9007199254740991], link: [-1, 9007199254740991], orientation: [-2, 2] },
  [FromPage.GAMEPADS]: { gamepads: [-10, 10] },
  [FromPage.SPEED]: { speed: [0.0001, 10000] },
  [FromPage.RESTORE]: { mark: [0, 9007199254740991] },
  [FromPage.WORLDS]: { chosen: [0, 9007199254740991], shown: [1, 256] },
  [FromPage.SETTING]: { value: [-1e+09, 1e+09] },
});

/** What the type of a message begins with that removes what another one has shown. */
export const REMOVAL = "no ";

/**
 * What the history keeps messages by: the field with their number; empty without one.
 *
 * @type {Readonly<Record<string, string>>}
 */
export const KEPT_BY = Object.freeze({
  [ToPage.MESH]: "mesh",
  [ToPage.NO_MESH]: "mesh",
  [ToPage.TEXTURE]: "texture",
  [ToPage.NO_TEXTURE]: "texture",
  [ToPage.BODY]: "body",
  [ToPage.NO_BODY]: "body",
  [ToPage.DYNAMICS]: "dynamics",
  [ToPage.NO_DYNAMICS]: "dynamics",
  [ToPage.LAYOUT]: "",
  [ToPage.NO_LAYOUT]: "",
  [ToPage.CONSTRAINTS]: "",
  [ToPage.NO_CONSTRAINTS]: "",
  [ToPage.STAGE]: "",
  [ToPage.NO_STAGE]: "",
  [ToPage.PYRAMID]: "",
  [ToPage.NO_PYRAMID]: "",
  [ToPage.RAYS]: "",
  [ToPage.NO_RAYS]: "",
  [ToPage.LINE]: "item",
  [ToPage.TEXT]: "item",
  [ToPage.POINTS]: "item",
  [ToPage.NO_ITEM]: "item",
  [ToPage.SLIDER]: "slider",
  [ToPage.NO_SLIDER]: "slider",
});

/** Types of the messages that a spectator's page may send: all others do nothing. */
export const SPECTATING = new Set(["past", "preview width", "want"]);

/** Fields in which frames of the same run of a recording may differ. */
export const OWN_OF_FRAMES = new Set(["number", "picture", "rate", "time"]);
