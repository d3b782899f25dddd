// Functions for test_modules.py, which run in an empty page beside the modules of the viewer's.

import { MessageVersions } from "/time/message_versions.js";
import { Plots } from "/panel/plots.js";
import { Pointer } from "/input/pointer.js";
import { bounded } from "/bounded.js";

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
