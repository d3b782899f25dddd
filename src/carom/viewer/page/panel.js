// The panel: sliders and buttons of the script, time, and what is shown.

const TOGGLES = [
  ["shadows", "Shadows", "S"],
  ["wireframe", "Wireframe", "W"],
  ["frames", "Link frames", "J"],
  ["bounds", "Bounds", "A"],
  ["grid", "Grid", ""],
  ["names", "Names", ""],
  ["collisions", "Collisions", ""],
];

export class Panel {
  constructor(send, options, optionsChanged) {
    this.send = send;
    this.options = options;
    this.root = document.getElementById("panel");
    this.sliders = document.getElementById("sliders");
    this.controls = new Map();
    this.boxes = new Map();
    for (const [name, title, key] of TOGGLES) {
      const label = document.createElement("label");
      const box = Object.assign(document.createElement("input"), { type: "checkbox", name });
      box.addEventListener("change", () => {
        options[name] = box.checked;
        optionsChanged();
      });
      label.append(box, title);
      if (key) label.append(Object.assign(document.createElement("kbd"), { textContent: key }));
      document.getElementById("toggles").append(label);
      this.boxes.set(name, box);
    }
    this.showOptions();
    document.getElementById("close").addEventListener("click", () => send({ type: "close" }));
    this.pause = document.getElementById("pause");
    this.step = document.getElementById("step");
    this.paused = false;
    this.pause.addEventListener("click", () => send({ type: "pause", paused: !this.paused }));
    this.step.addEventListener("click", () => send({ type: "step" }));
  }

  showOptions() {
    for (const [name, box] of this.boxes) box.checked = this.options[name];
    this.root.hidden = !this.options.panel;
  }

  showPause({ paused }) {
    this.paused = paused;
    this.pause.textContent = paused ? "Continue" : "Pause";
    this.step.disabled = !paused;
  }

  showTime({ time, rate }) {
    document.getElementById("clock").textContent = time.toFixed(3);
    document.getElementById("rate").textContent = rate.toFixed(2);
  }

  showFps(fps) {
    document.getElementById("fps").textContent = fps.toFixed(0);
  }

  showTitle({ title }) {
    document.title = title;
    document.getElementById("title").textContent = title;
  }

  addSlider(message) {
    const known = this.controls.get(message.slider);
    if (known) known.show(message);
    else this.controls.set(message.slider, message.button ? this.makeButton(message) : this.makeSlider(message));
  }

  removeSlider({ slider }) {
    this.controls.get(slider)?.element.remove();
    this.controls.delete(slider);
  }

  clear() {
    for (const slider of [...this.controls.keys()]) this.removeSlider({ slider });
  }

  makeButton({ slider, name }) {
    const element = Object.assign(document.createElement("div"), { className: "slider" });
    const button = Object.assign(document.createElement("button"), { textContent: name });
    button.addEventListener("click", () => this.send({ type: "press", slider }));
    element.append(button);
    this.sliders.append(element);
    return { element, show() {} };
  }

  makeSlider(message) {
    const element = Object.assign(document.createElement("div"), { className: "slider" });
    const label = document.createElement("label");
    const reading = document.createElement("output");
    const input = Object.assign(document.createElement("input"), { type: "range", step: "any" });
    label.append(message.name, reading);
    label.htmlFor = input.id = `slider-${message.slider}`;
    element.append(label, input);
    this.sliders.append(element);
    const digits = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(message.upper - message.lower || 1))));
    const read = () => (reading.textContent = Number(input.value).toFixed(digits));
    let held = false;
    input.addEventListener("pointerdown", () => (held = true));
    for (const kind of ["pointerup", "pointercancel"]) window.addEventListener(kind, () => (held = false));
    input.addEventListener("input", () => {
      read();
      this.send({ type: "slider", slider: message.slider, value: Number(input.value) });
    });
    const show = ({ lower, upper, value }) => {
      // While the user moves it, what comes back is where it was.
      if (held) return;
      [input.min, input.max, input.value] = [lower, upper, value];
      read();
    };
    show(message);
    return { element, show };
  }
}
