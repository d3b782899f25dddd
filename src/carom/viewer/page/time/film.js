// A video of the recording, drawn picture by picture: as sharp and as smooth on a slow machine as on a fast one.

import { webm } from "./webm.js";

const FPS = 30;
/** Bits for each pixel of each picture. */
const BITS = 0.12;
const KEY_EVERY = 60;
/** Pictures that may wait for the encoder. */
const MAX_WAITING = 4;
/** Names of codecs in the browser and in a WebM file, the best first. */
const CODECS = [
  ["vp09.00.51.08", "V_VP9"],
  ["vp8", "V_VP8"],
];

/**
 * Films the recording from one moment to another.
 *
 * @param {(clock: number) => HTMLCanvasElement} draw returns the picture of a moment of the recording
 * @param {{from: number, to: number, speed: number}} span moments on the history's clock [s]; speed of the film
 * @param {(share: number) => boolean} progress called with the share that is done; false ends the work
 * @returns {Promise<?Blob>} null if it was ended
 */
export async function filmOf(draw, { from, to, speed }, progress) {
  const count = Math.max(1, Math.floor(((to - from) / speed) * FPS) + 1);
  const first = draw(from);
  const { codec, name } = await codecFor(first.width, first.height);
  const pictures = [];
  let problem = null;
  const encoder = new VideoEncoder({
    output: (chunk) => {
      const bytes = new Uint8Array(chunk.byteLength);
      chunk.copyTo(bytes);
      pictures.push({ time: Math.round(chunk.timestamp / 1000), key: chunk.type === "key", bytes });
    },
    error: (error) => (problem = error),
  });
  encoder.configure(codec);
  try {
    for (let number = 0; number < count; number++) {
      const picture = draw(Math.min(from + (number / FPS) * speed, to));
      const frame = new VideoFrame(picture, { timestamp: (number * 1e6) / FPS, duration: 1e6 / FPS });
      encoder.encode(frame, { keyFrame: number % KEY_EVERY === 0 });
      frame.close();
      // The page stays alive meanwhile: clicks are seen, and messages of the simulation arrive.
      do await new Promise((go) => setTimeout(go));
      while (encoder.encodeQueueSize > MAX_WAITING && problem === null);
      if (problem !== null) throw problem;
      if (!progress((number + 1) / count)) return null;
    }
    await encoder.flush();
  } finally {
    if (encoder.state !== "closed") encoder.close();
  }
  return webm({ width: first.width, height: first.height, codec: name, duration: (count * 1000) / FPS }, pictures);
}

async function codecFor(width, height) {
  if (!("VideoEncoder" in window)) throw new Error("this browser, or an address without https, has no video encoder");
  for (const [codec, name] of CODECS) {
    const wanted = { codec, width, height, framerate: FPS, bitrate: Math.round(BITS * FPS * width * height) };
    if ((await VideoEncoder.isConfigSupported(wanted)).supported) return { codec: wanted, name };
  }
  throw new Error(`this browser cannot encode a video of ${width} x ${height} pixels`);
}
