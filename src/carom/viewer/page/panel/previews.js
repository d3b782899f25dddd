// Previews of the script's last camera image: colours, depth and segmentation.

const KINDS = ["rgbPreview", "depthPreview", "segmentationPreview"];
const TITLES = ["colour", "depth", "segmentation"];

export class Previews {
  constructor() {
    this.root = document.getElementById("previews");
    this.figures = TITLES.map((title) => {
      const figure = document.createElement("figure");
      figure.append(document.createElement("canvas"));
      figure.append(Object.assign(document.createElement("figcaption"), { textContent: title }));
      return figure;
    });
    this.clear();
    this.root.append(...this.figures);
  }

  clear() {
    this.taken = false;
    this.root.hidden = true;
  }

  take({ width, height }, payload) {
    const bytes = new Uint8Array(payload);
    this.figures.forEach((figure, index) => {
      const canvas = figure.firstChild;
      [canvas.width, canvas.height] = [width, height];
      const picture = new ImageData(width, height);
      let from = index * width * height * 3;
      for (let to = 0; to < picture.data.length; to += 4, from += 3) {
        picture.data.set([bytes[from], bytes[from + 1], bytes[from + 2], 255], to);
      }
      canvas.getContext("2d").putImageData(picture, 0, 0);
    });
    this.taken = true;
  }

  show(options) {
    this.root.hidden = !this.taken || !options.panel;
    this.figures.forEach((figure, index) => (figure.hidden = !options[KINDS[index]]));
  }
}
