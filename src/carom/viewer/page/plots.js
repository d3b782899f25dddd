// Charts of what joints do, beside what they are told to do.

const SECONDS = 10;
const QUANTITIES = [
  { name: "position", at: 2, target: 5 },
  { name: "velocity", at: 3, target: 6 },
  { name: "torque", at: 4, target: 7 },
];
const LINE = "#1f6fb2";
const TARGET = "#e08a1e";

export class Plots {
  constructor(send) {
    this.send = send;
    this.select = document.getElementById("joint");
    this.root = document.getElementById("charts");
    this.plotted = new Map();
    this.known = "";
    this.select.addEventListener("change", () => {
      if (this.select.value) this.add(this.select.value, this.select.selectedOptions[0].textContent);
      this.select.value = "";
    });
  }

  /** Offers the joints there are. */
  offer(scene) {
    const joints = [];
    for (const body of scene.bodies.values()) {
      body.links.forEach((link, index) => {
        if (/revolute|continuous|prismatic/.test(link.kind ?? "")) {
          joints.push([`${body.body},${index - 1}`, `${body.name} · ${link.joint}`]);
        }
      });
    }
    const known = JSON.stringify(joints);
    if (known === this.known) return;
    this.known = known;
    this.select.replaceChildren(new Option("Plot a joint…", ""), ...joints.map(([value, name]) => new Option(name, value)));
    document.getElementById("plots").hidden = joints.length === 0;
    for (const key of this.plotted.keys()) if (!joints.some(([value]) => value === key)) this.remove(key);
  }

  add(key, title) {
    if (this.plotted.has(key)) return;
    const root = Object.assign(document.createElement("div"), { className: "chart" });
    const header = document.createElement("header");
    const close = Object.assign(document.createElement("button"), { textContent: "✕", title: "Remove" });
    close.addEventListener("click", () => this.remove(key));
    header.append(title, close);
    root.append(header);
    const canvases = QUANTITIES.map(({ name }) => {
      const canvas = Object.assign(document.createElement("canvas"), { title: name });
      root.append(canvas);
      return canvas;
    });
    this.root.append(root);
    this.plotted.set(key, { root, canvases, samples: [] });
    this.tell();
  }

  remove(key) {
    this.plotted.get(key)?.root.remove();
    this.plotted.delete(key);
    this.tell();
  }

  tell() {
    this.send({ type: "plot", joints: [...this.plotted.keys()].map((key) => key.split(",").map(Number)) });
  }

  take({ time, joints }) {
    for (const sample of joints ?? []) {
      const plot = this.plotted.get(`${sample[0]},${sample[1]}`);
      if (!plot) continue;
      const { samples } = plot;
      if (samples.length && time < samples.at(-1).time) samples.length = 0;
      if (!samples.length || time > samples.at(-1).time) samples.push({ time, sample });
      while (samples[0].time < time - SECONDS) samples.shift();
      QUANTITIES.forEach(({ name, at }) => (plot.root.dataset[name] = sample[at]));
    }
  }

  draw() {
    for (const { canvases, samples } of this.plotted.values()) {
      canvases.forEach((canvas, index) => drawChart(canvas, samples, QUANTITIES[index]));
    }
  }
}

function drawChart(canvas, samples, { name, at, target }) {
  const ratio = window.devicePixelRatio;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  context.font = "10px system-ui, sans-serif";
  context.fillStyle = "#5b6b7a";
  context.fillText(name, 4, 11);
  if (samples.length === 0) return;
  const columns = [at, target];
  const values = samples.flatMap(({ sample }) => columns.map((column) => sample[column]).filter((x) => x !== null));
  let [low, high] = [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
  const margin = Math.max((high - low) * 0.1, 1e-3);
  [low, high] = [low - margin, high + margin];
  const end = samples.at(-1).time;
  const x = (time) => width - 4 - ((end - time) / SECONDS) * (width - 8);
  const y = (value) => height - 4 - ((value - low) / (high - low)) * (height - 20);
  const trace = (column, colour, dash) => {
    context.strokeStyle = colour;
    context.setLineDash(dash);
    context.beginPath();
    let drawing = false;
    for (const { time, sample } of samples) {
      if (sample[column] === null) drawing = false;
      else {
        context[drawing ? "lineTo" : "moveTo"](x(time), y(sample[column]));
        drawing = true;
      }
    }
    context.stroke();
  };
  context.lineWidth = 1.4;
  trace(target, TARGET, [4, 3]);
  trace(at, LINE, []);
  const now = samples.at(-1).sample;
  const text = now[at].toPrecision(4) + (now[target] !== null ? ` → ${now[target].toPrecision(4)}` : "");
  context.fillText(text, width - 4 - context.measureText(text).width, 11);
}
