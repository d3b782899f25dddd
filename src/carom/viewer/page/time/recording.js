// Packs a history into bytes and unpacks it; src/carom/viewer/replay/recording.py documents the format.

import { OWN_OF_FRAMES } from "../protocol.js";

const FORMAT = 1;

/** The scene messages of a history and their removals, in order of the frames they were first shown with. */
export function messagesOf(history) {
  const events = [];
  for (const [name, list] of history.messages.versions) {
    for (const { from, to, message } of list) {
      events.push({ moment: Math.max(from, history.first), order: 1, ...message });
      if (to !== Infinity) events.push({ moment: to, order: 0, name });
    }
  }
  return events.sort((a, b) => a.moment - b.moment || a.order - b.order);
}

/** Packs a history: an index with further data (`facts`), then the bytes of messages and runs of frames. */
export async function encoded(history, facts, removal) {
  const events = messagesOf(history);
  const records = [];
  const parts = [];
  let at = 0;
  const tellUntil = (moment) => {
    for (; at < events.length && events[at].moment <= moment; at++) {
      const { header, payload, name } = events[at];
      const message = header ?? removal(name);
      records.push({ message, bytes: payload?.byteLength ?? 0 });
      if (payload?.byteLength) parts.push(new Uint8Array(payload));
    }
  };
  let run = [];
  const endRun = () => {
    if (run.length === 0) return;
    const shared = sharedPart(run[0].header);
    const floats = run[0].payload.byteLength / 4;
    records.push({ frames: run.length, floats, header: shared, times: run.map((frame) => frame.header.time) });
    parts.push(planes(run.map((frame) => new Uint32Array(frame.payload)), floats));
    run = [];
  };
  history.frames.forEach((frame, index) => {
    const moment = history.first + index;
    if (run.length && !(sameRun(run[0], frame) && !(events[at]?.moment <= moment))) endRun();
    tellUntil(moment);
    run.push(frame);
  });
  endRun();
  const index = new TextEncoder().encode(JSON.stringify({ format: FORMAT, ...facts, records }));
  const length = new Uint8Array(new Uint32Array([index.length]).buffer);
  return through(new Blob([length, index, ...parts]), new CompressionStream("deflate"));
}

/** The further data of a recording, and its messages in order, as pairs of header and payload. */
export async function decoded(bytes) {
  const plain = await through(new Blob([bytes]), new DecompressionStream("deflate"));
  const length = new DataView(plain).getUint32(0, true);
  const { records, ...facts } = JSON.parse(new TextDecoder().decode(new Uint8Array(plain, 4, length)));
  if (facts.format !== FORMAT) throw new Error(`This recording has format ${facts.format}; this page reads ${FORMAT}.`);
  const messages = [];
  let at = 4 + length;
  for (const record of records) {
    if (record.message) {
      messages.push([record.message, plain.slice(at, at + record.bytes)]);
      at += record.bytes;
      continue;
    }
    const size = 4 * record.floats * record.frames;
    const frames = fromPlanes(new Uint8Array(plain, at, size), record.frames, record.floats);
    frames.forEach((payload, i) => messages.push([{ ...record.header, time: record.times[i] }, payload]));
    at += size;
  }
  return { facts, messages };
}

function sameRun(a, b) {
  if (a.payload.byteLength !== b.payload.byteLength) return false;
  return JSON.stringify(sharedPart(a.header)) === JSON.stringify(sharedPart(b.header));
}

/** What of the header of a frame the frames of a run share. */
function sharedPart(header) {
  return Object.fromEntries(Object.entries(header).filter(([name]) => !OWN_OF_FRAMES.has(name)));
}

/** Frames as bitwise XOR with the frame before, sorted by byte: small changes give zeros, which pack well. */
function planes(frames, floats) {
  const [count, size] = [frames.length, frames.length * floats];
  const result = new Uint8Array(4 * size);
  for (let i = 0; i < count; i++) {
    for (let column = 0; column < floats; column++) {
      const bits = frames[i][column] ^ (i ? frames[i - 1][column] : 0);
      const at = column * count + i;
      for (let plane = 0; plane < 4; plane++) result[plane * size + at] = bits >>> (8 * plane);
    }
  }
  return result;
}

function fromPlanes(bytes, count, floats) {
  const size = count * floats;
  let last = new Uint32Array(floats);
  return Array.from({ length: count }, (_, i) => {
    const frame = new Uint32Array(floats);
    for (let column = 0; column < floats; column++) {
      const at = column * count + i;
      const bits = bytes[at] | (bytes[size + at] << 8) | (bytes[2 * size + at] << 16) | (bytes[3 * size + at] << 24);
      frame[column] = last[column] ^ bits;
    }
    last = frame;
    return frame.buffer;
  });
}

async function through(blob, stream) {
  return new Response(blob.stream().pipeThrough(stream)).arrayBuffer();
}
