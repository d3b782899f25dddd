// Pictures of the view in any size, with its texts: not those that are on the screen, which may be coarse.

import { element } from "../elements.js";

/** @import { App } from "../app.js" */

/** Width from which on a picture is not drawn twice as large to smooth its edges [pixels]. */
const LARGE = 2049;

export class Shots {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.select = element("size", HTMLSelectElement);
    this.picture = document.createElement("canvas");
  }

  /** Width and height of pictures [pixels]: those chosen, or those of the screen; even, as videos need it. */
  get size() {
    const { canvas } = this.app;
    const [width, height] = this.select.value.split("x").map(Number);
    if (height) return [width, height];
    return [canvas.clientWidth, canvas.clientHeight].map((side) => 2 * Math.max(1, Math.round((side * window.devicePixelRatio) / 2)));
  }

  /** Draws the view as it is now; the canvas that is returned is used again for the next picture. */
  draw() {
    const { app, picture } = this;
    const { canvas, views, renderer } = app;
    const [width, height] = this.size;
    // Without a GPU edges are not smoothed.
    const finer = renderer.byProcessor && width < LARGE ? 2 : 1;
    const ratio = height / canvas.clientHeight;
    const before = [canvas.width, canvas.height];
    [canvas.width, canvas.height] = [width * finer, height * finer];
    // Nothing covers the views of a picture.
    views.arrange(width / ratio, height / ratio, () => ({ side: 0, below: 0 }));
    renderer.pace.careful = true;
    try {
      const { drawingBufferWidth, drawingBufferHeight } = renderer.gl;
      if (drawingBufferWidth < width || drawingBufferHeight < height) throw new Error(`the graphics cannot draw ${width} x ${height} pixels`);
      app.drawScene();
      [picture.width, picture.height] = [width, height];
      const context = picture.getContext("2d");
      context.imageSmoothingQuality = "high";
      context.drawImage(canvas, 0, 0, width, height);
      write(context, ratio);
    } finally {
      renderer.pace.careful = false;
      [canvas.width, canvas.height] = before;
      app.arrange();
      app.drawScene();
    }
    return picture;
  }
}

/** Draws the texts that are over the view into a picture. */
function write(context, ratio) {
  for (const span of document.querySelectorAll("#labels span:not([hidden])")) {
    const { left, bottom } = span.getBoundingClientRect();
    const style = getComputedStyle(span);
    context.font = `${style.fontWeight} ${parseFloat(style.fontSize) * ratio}px ${style.fontFamily}`;
    context.fillStyle = style.color;
    context.fillText(span.textContent, left * ratio, (bottom - 4) * ratio);
  }
}
