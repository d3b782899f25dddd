// The page: brings messages to what they are for, and draws.

import { Camera } from "./camera.js";
import { Connection } from "./connection.js";
import { Drawings } from "./drawings.js";
import { Keys } from "./keys.js";
import { Options } from "./options.js";
import { Panel } from "./panel.js";
import { Grasp, pick } from "./picking.js";
import { Plots } from "./plots.js";
import { Pointer } from "./pointer.js";
import { Previews } from "./previews.js";
import { Renderer } from "./renderer.js";
import { Scene } from "./scene.js";

/** After so long without a change nothing is going on [ms]. */
const STILL_MS = 500;

const canvas = document.getElementById("view");
const notice = document.getElementById("notice");

function say(text) {
  notice.textContent = text ?? "";
  notice.hidden = !text;
}

function start() {
  const renderer = new Renderer(canvas);
  const scene = new Scene(renderer.gl);
  const camera = new Camera();
  const options = new Options();
  const drawings = new Drawings(renderer.gl, document.getElementById("labels"));
  let stale = true;
  let cameraMovedByUser = false;
  /** Number of the picture that the script waits for, once it is to be drawn. */
  let awaited = null;
  let told = 0;
  const changed = () => (stale = true);
  const optionsChanged = () => {
    camera.yUp = options.yUp;
    camera.update();
    panel.showOptions();
    previews.show(options);
    send({ type: "want", collisions: options.collisions });
    changed();
  };
  const cameraMoved = () => {
    cameraMovedByUser = true;
    changed();
  };
  const tellSize = () => send({ type: "size", width: camera.width, height: camera.height });
  const tellVisibility = () => send({ type: "visible", visible: !document.hidden });
  document.addEventListener("visibilitychange", tellVisibility);
  const send = (message) => connection.send(message);
  const panel = new Panel(send, options, optionsChanged);
  const plots = new Plots(send);
  const previews = new Previews();
  new Keys(send, options, optionsChanged);
  const pointer = new Pointer(canvas, camera, send, cameraMoved);
  pointer.hoverChanged = () => options.names && changed();
  pointer.grasp = new Grasp(scene, camera, options, send);

  const answers = {
    title: (header) => panel.showTitle(header),
    mesh: (header, payload) => scene.addMesh(header, payload),
    "no mesh": (header) => scene.removeMesh(header),
    texture: (header, payload) => scene.addTexture(header, payload),
    "no texture": (header) => scene.removeTexture(header),
    body: (header) => scene.addBody(header),
    "no body": (header) => scene.removeBody(header),
    layout: (header) => {
      scene.layout = header;
      plots.offer(scene);
    },
    frame: (header, payload) => {
      scene.place(header, payload);
      panel.showTime(header);
      plots.take(header);
      if (header.picture !== told) awaited = told = header.picture;
    },
    previews: (header, payload) => {
      previews.take(header, payload);
      previews.show(options);
    },
    line: (header) => drawings.add(header),
    text: (header) => drawings.add(header),
    points: (header, payload) => drawings.add(header, payload),
    "no item": (header) => drawings.remove(header),
    slider: (header) => panel.addSlider(header),
    "no slider": (header) => panel.removeSlider(header),
    pause: (header) => panel.showPause(header),
    camera: (header) => camera.set(header),
    options: (header) => {
      options.take(header);
      optionsChanged();
    },
  };
  const connection = new Connection(
    (header, payload) => {
      answers[header.type]?.(header, payload);
      changed();
    },
    (connected) => {
      say(connected ? null : "The simulation has ended. Waiting for the next…");
      if (!connected) return;
      // It tells everything from the beginning.
      scene.clear();
      drawings.clear();
      panel.clear();
      previews.clear();
      [awaited, told] = [null, 0];
      tellVisibility();
      tellSize();
      plots.tell();
      send({ type: "want", collisions: options.collisions });
    },
  );

  let moved = 0;
  let drawn = false;
  let last = performance.now();
  let frames = 0;
  let since = performance.now();
  function draw(now) {
    requestAnimationFrame(draw);
    if (drawn) renderer.pace(now - last);
    last = now;
    drawn = false;
    if (stale) moved = now;
    renderer.still = now - moved > STILL_MS;
    if (renderer.resize()) changed();
    if (camera.width !== canvas.clientWidth || camera.height !== canvas.clientHeight) {
      camera.resize(canvas.clientWidth, canvas.clientHeight);
      tellSize();
      changed();
    }
    if (cameraMovedByUser) {
      cameraMovedByUser = false;
      send({ type: "camera", ...camera.state() });
    }
    frames += 1;
    if (now - since > 500) {
      panel.showFps((frames * 1000) / (now - since));
      [frames, since] = [0, now];
    }
    if (!stale) return;
    stale = false;
    if (options.rendering) drawScene();
    if (awaited !== null) send({ type: "drawn", picture: awaited });
    awaited = null;
  }
  function drawScene() {
    drawn = true;
    const named = options.names && pointer.hovered && !pointer.grasp.busy ? underMouse() : null;
    const more = [pointer.grasp.line()].filter((line) => line !== null);
    const lines = drawings.lines(scene, options, more, named);
    renderer.draw(scene, camera, options, { lines, clouds: drawings.clouds, signs: drawings.signs });
    drawings.placeLabels(scene, camera);
    drawings.showName(scene, named, pointer.hovered);
    plots.draw();
  }
  function underMouse() {
    return pick(scene, options, camera.eye, camera.ray(...pointer.hovered));
  }
  requestAnimationFrame(draw);
}

try {
  start();
} catch (error) {
  say(error.message);
  throw error;
}
