// Functions for test_modules.py, which run in an empty page beside the modules of the viewer's.

import { MessageVersions } from "./time/message_versions.js";
import { Connection } from "./connection.js";
import { Dock } from "./panel/dock.js";
import { Options } from "./panel/options.js";
import { Plots } from "./panel/plots.js";
import { Handles } from "./input/handles.js";
import { Pinch } from "./input/pinch.js";
import { Pointer } from "./input/pointer.js";
import { Toggles } from "./panel/toggles.js";
import { bounded } from "./bounded.js";
import { trailOf } from "./time/trail.js";
import { ArrowScale } from "./view/arrows/arrow_scale.js";
import { boundsOfLink } from "./view/bounds.js";
import { Camera } from "./view/camera.js";
import { labelLinks } from "./view/labels.js";
import { INSTANCE_FLOATS, Level } from "./view/level.js";
import { LINE_FLOATS } from "./view/lines.js";
import { POSE_FLOATS } from "./view/scene.js";
import { SharpLines } from "./view/software/sharp_lines.js";
import { Stage } from "./view/stage/stage.js";

export function bounds(list) {
  return list.map(bounded);
}

// What is shown in frames 0 to 6: a message is put at frame 1, replaced at 3 and removed at 5; another stays.
export function shown() {
  const versions = new MessageVersions();
  const message = (text) => ({ header: { text }, payload: new ArrayBuffer(0) });
  versions.put("stays", message("s"), 0);
  versions.put("goes", message("a"), 1);
  versions.put("goes", message("b"), 3);
  versions.remove("goes", 5);
  const at = (moment) => [...versions.at(moment).values()].map(({ message }) => message.header.text).join("");
  const shown = [0, 1, 2, 3, 4, 5, 6].map(at);
  const kept = [2, 3, 4, 5].map((moment) => {
    versions.forget(moment);
    return [versions.versions.get("goes")?.length ?? 0, versions.bytes / 400];
  });
  return [shown, kept, [4, 5].map(at), versions.newest("goes"), versions.newest("stays").header.text];
}

// Of before the page joined, at its frame 0: a message that is still there, one that another has replaced, one that
// had gone, and one of which the simulation says that it is still shown, but which the page has not been sent.
export function earlier() {
  const versions = new MessageVersions();
  const message = (text) => ({ header: { text }, payload: new ArrayBuffer(0) });
  versions.put("same", message("s"), 0);
  versions.put("replaced", message("new"), 0);
  versions.prepend([
    { name: "same", from: -3, to: Infinity, message: message("s") },
    { name: "replaced", from: -3, to: Infinity, message: message("old") },
    { name: "gone", from: -3, to: -1, message: message("g") },
    { name: "left", from: -3, to: Infinity, message: message("l") },
  ]);
  const at = (moment) => [...versions.at(moment)].map(([name, { message }]) => `${name} ${message.header.text}`).sort();
  return [[-3, -2, -1, 0].map(at), ["same", "replaced", "gone", "left"].map((name) => versions.newest(name)?.header.text)];
}

export function wants() {
  const { wants } = Object.getOwnPropertyDescriptors(Plots.prototype);
  const plotted = [{ joints: [1] }, { links: [[2, -1]] }, { sensors: [3] }, { sensors: [4] }, { contacts: true }, {}];
  const asked = (list) => wants.get.call({ plotted: new Map(list.map((wants, i) => [i, { source: { wants } }])) });
  return [asked(plotted), asked([])];
}

// A drag of which the browser tells no motion but by the release of the button; a click; a drag that is cancelled.
export function motions() {
  const told = [];
  const tell = (name) => (...values) => told.push([name, ...values]);
  const canvas = { addEventListener() {}, focus() {}, setPointerCapture() {} };
  const camera = { orbit: tell("orbit"), lens: null };
  const send = ({ x, y, down }) => told.push(["mouse", x, y, down ?? null]);
  const pointer = new Pointer(canvas, camera, send, tell("moved"));
  const grasp = { busy: false, begin: tell("begin"), move: tell("move"), end: tell("end") };
  pointer.grasp = grasp;
  pointer.clicked = tell("clicked");
  const event = (type, offsetX, offsetY) => ({ type, offsetX, offsetY, button: 0, pointerId: 1, ctrlKey: false, altKey: false, shiftKey: false });
  const taken = (...events) => {
    told.length = 0;
    const takers = { pointerdown: "down", pointermove: "move", pointerup: "up", pointercancel: "up" };
    for (const each of events) pointer[takers[each.type]](each);
    return structuredClone(told);
  };
  const turned = taken(event("pointerdown", 10, 10), event("pointerup", 40, 10));
  const clicked = taken(event("pointerdown", 10, 10), event("pointerup", 10, 10));
  const cancelled = taken(event("pointerdown", 10, 10), event("pointercancel", 0, 0));
  grasp.busy = true;
  const pulled = taken(event("pointerdown", 10, 10), event("pointermove", 20, 10), event("pointerup", 40, 15));
  return { turned, clicked, cancelled, pulled };
}

// The scale of arrows after each of some pictures: the largest amount, and the time.
export function scales(pictures) {
  const scale = new ArrowScale();
  return pictures.map(([largest, time]) => {
    scale.fit(largest, 1, time);
    return scale.perMetre;
  });
}

// Positions of a link in so many frames one second apart, of which the first of many has another layout; then those of
// no link, of a link that is not there, and of a frame that is not.
export function trails(count) {
  const frames = Array.from({ length: count }, (_, i) => ({
    header: { layout: i === 0 && count > 3 ? 1 : 2, poses: 2 },
    payload: new Float32Array(2 * POSE_FLOATS).fill(i, POSE_FLOATS).buffer,
    clock: i,
  }));
  const scene = { poseAt: (body, link) => (body === 3 ? link * POSE_FLOATS : -1) };
  const trail = (index, selection) => trailOf({ frames }, index, scene, selection);
  const link = { body: 3, link: 1 };
  return [trail(count - 1, link), trail(2, link), trail(2, { body: 3, link: null })].map((places) => places.map(([x]) => x))
    .concat([trail(2, null), trail(2, { body: 4, link: 1 }), trail(count, link)]);
}

// The names that are shown: of the base and of a link, and none of a hidden body or of a link without a pose.
export function names() {
  const links = [{ name: "base" }, { name: "" }, { name: "lost" }];
  const bodies = new Map([[1, { body: 1, name: "arm", links }], [2, { body: 2, name: "hidden", links }]]);
  const linkPose = (body, link) => (link < 2 ? { position: [body, link, 0] } : null);
  const shown = [];
  labelLinks({ add: (camera, point, text) => shown.push([text, ...point]) }, null, { bodies, hidden: new Set([2]), linkPose });
  return shown;
}

// What is sent to the GPU of shapes on links with poses: scaled axes, origin, colour and specular colour of each.
export function instances({ poses, shapes }) {
  const level = Object.assign(Object.create(Level.prototype), { data: new Float32Array(0) });
  level.begin(shapes.length);
  shapes.forEach((shape, link) => level.push(new Float32Array(poses.flat()), POSE_FLOATS * link, shape, shape.colour));
  return shapes.map((_, at) => [...level.data.subarray(INSTANCE_FLOATS * at, INSTANCE_FLOATS * (at + 1))]);
}

function canvasOfSharpLines() {
  const canvas = Object.assign(document.createElement("canvas"), { id: "sharp-lines" });
  document.body.append(canvas);
  return canvas;
}

// Lines that are seen through bodies, over a coarse picture of 40 by 20 pixels: whether any are shown, and which of red,
// green and blue there is in the middles of the left and of the right half; with two lines, one, and none.
export function sharpLines() {
  const canvas = canvasOfSharpLines();
  const lines = new SharpLines({ clientWidth: 40, clientHeight: 20 });
  const line = (from, to, colour) => [from, 0, 0, to, 0, 0, ...colour, 6];
  const data = new Float32Array([line(-0.9, -0.1, [1, 0, 0]), line(0.1, 0.9, [0, 0, 1])].flat());
  const matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  return [0, 1, 2, 0].map((outside) => {
    lines.draw({ outside, count: 2, data, used: data.subarray(0, 2 * LINE_FLOATS) }, { matrix, left: 0, top: 0, width: 40, height: 20 }, true);
    if (canvas.hidden) return [false];
    const middle = (share) => [...lines.context.getImageData(share * canvas.width, canvas.height / 2, 1, 1).data].slice(0, 3);
    return [true, middle(0.25), middle(0.75)];
  });
}

// How far from the middle of a handle its knobs are, seen from so many metres away along an axis that is not the view's.
export function knobs(distances) {
  return distances.map((distance) => {
    const item = { position: [1, 2, 3], orientation: [0, 0, 0, 1] };
    const found = Handles.prototype.knobs.call({}, item, [1 - distance, 2, 3 + 5], [1, 0, 0]);
    return found.map(({ kind, point }) => [kind, Math.hypot(...point.map((x, i) => x - item.position[i]))]);
  });
}

// The box of a link with a flat shape: a sheet across x; and that of a link whose mesh has not arrived.
export function sheet() {
  const shape = (link, mesh) => ({ link, position: [1, 0, 0], orientation: [0, 0, 0, 1], scale: [1, 2, 3], meshes: [[mesh]] });
  const body = { body: 1, shapes: [shape(0, 7), shape(1, 8)] };
  const meshes = new Map([[7, { bounds: { lower: [0, -1, -1], upper: [0, 1, 1] } }]]);
  const scene = { meshes, inertialPose: () => ({ position: [0, 0, 1], orientation: [0, 0, 0, 1] }) };
  return [0, 1].map((link) => boundsOfLink(scene, body, link, false));
}

// What a camera does when one finger moves, when the second of two does, and when one of them has gone.
export function pinches() {
  const told = [];
  const camera = { distance: 2, left: 0, top: 0, width: 100, height: 100 };
  camera.zoom = (factor) => {
    told.push(["zoom", factor]);
    camera.distance *= factor;
  };
  camera.pan = (...way) => told.push(["pan", ...way]);
  const pinch = new Pinch(camera);
  const finger = (pointerId, offsetX, offsetY) => ({ pointerType: "touch", pointerId, offsetX, offsetY });
  const step = (act) => {
    told.length = 0;
    act();
    return structuredClone(told);
  };
  pinch.down(finger(1, 40, 50));
  const alone = step(() => pinch.move(finger(1, 50, 50)));
  pinch.down(finger(2, 60, 50));
  const spread = step(() => pinch.move(finger(2, 70, 50)));
  pinch.up(finger(1, 50, 50));
  return [alone, spread, step(() => pinch.move(finger(2, 90, 50)))];
}

// The switches that a new page would not take over from the last one: those that are not on or off.
export function undecided() {
  document.body.append(Object.assign(document.createElement("div"), { id: "toggles" }));
  const options = new Options();
  const names = [...new Toggles(options, () => {}).boxes.keys()];
  return [names.length, names.filter((name) => typeof options[name] !== "boolean")];
}

// What is kept of the pane of plots when it is opened and closed.
export function docks() {
  const kept = [];
  const made = () => document.createElement("div");
  const memory = { put: (name, value) => kept.push([name, value]) };
  const dock = Object.create(Dock.prototype);
  Object.assign(dock, { root: made(), button: made(), part: { clear() {} }, memory, changed() {}, height: 240 });
  dock.open(true);
  dock.open(false);
  return kept;
}

// How often the page begins anew if the server answers with these numbers, and with no messages, until it is gone.
export async function polls(numbers) {
  history.replaceState(null, "", "?token=1");
  const answers = numbers.map((number) => new Uint32Array([number]).buffer);
  globalThis.fetch = async () => {
    const answer = answers.shift();
    return { ok: answer !== undefined, arrayBuffer: async () => answer };
  };
  let changes = 0;
  const connection = Object.create(Connection.prototype);
  Object.assign(connection, { hadSocket: false, folder: "/", changed: () => (changes += 1) });
  await connection.poll();
  return changes;
}

// What the frame of a notebook shows, which runs the script, if no server is there.
export async function notebook(script) {
  const frame = Object.assign(document.createElement("iframe"), { id: "frame" });
  document.body.append(frame);
  await (0, eval)(script);
  return frame.srcdoc;
}

// How many pictures each of some looks at the page draws: whether the canvas got another size before it, and whether
// something else has changed.
export async function drawn(looks) {
  const { App } = await import("./app.js");
  let pictures = 0;
  let resized = false;
  const renderer = { pace: { note() {}, wait() {} }, resize: () => resized, lost: false };
  const app = Object.assign(Object.create(App.prototype), {
    renderer, saving: { rendering: false }, player: { tick() {} }, gamepads: { tell() {} }, options: { rendering: true },
    drawn: false, stale: false, cameraToTell: false, awaited: null, last: 0, since: 0, frames: 0, moved: 0,
    fitCanvas() {}, drawScene: () => (pictures += 1),
  });
  return looks.map(([size, change]) => {
    const before = pictures;
    resized = size;
    if (change) app.changed();
    app.draw(1, false);
    return pictures - before;
  });
}

// From where a camera looks; and from where what is mirrored is drawn, with the height of the plane: if nothing mirrors,
// if the ground does because the script wants it, and if a plane of a file does at a height of 0.25 m.
export async function reflections() {
  const { rendererFor } = await import("./view/renderer.js");
  canvasOfSharpLines();
  const renderer = rendererFor(document.createElement("canvas"));
  const scene = { groups: [], bodies: new Map(), hidden: new Set(), textures: new Map() };
  const camera = new Camera();
  const seen = (wanted, mirror) => {
    const found = [];
    const { surfaces } = renderer;
    surfaces.begin = (features, { eye, mirrorLevel }) => features.includes("ABOVE_GROUND") && found.push([eye, mirrorLevel]);
    renderer.stage = Object.create(new Stage(scene), { mirror: { value: mirror } });
    renderer.drawWorld(scene, camera, Object.assign(new Options(), { reflections: wanted }), true, () => renderer.aimAtCanvas());
    return found;
  };
  return [camera.eye, seen(false, null), seen(true, null), seen(false, { height: 0.25, share: 0.5 })];
}
