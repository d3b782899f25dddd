// Packs encoded pictures into a WebM file: EBML elements, each an id, a size and its content.

const ID = {
  ebml: 0x1a45dfa3, version: 0x4286, readVersion: 0x42f7, longestId: 0x42f2, longestSize: 0x42f3, kind: 0x4282,
  kindVersion: 0x4287, kindReadVersion: 0x4285, segment: 0x18538067, info: 0x1549a966, scale: 0x2ad7b1, duration: 0x4489,
  muxer: 0x4d80, writer: 0x5741, tracks: 0x1654ae6b, track: 0xae, number: 0xd7, uid: 0x73c5, lacing: 0x9c, type: 0x83,
  codec: 0x86, video: 0xe0, width: 0xb0, height: 0xba, cues: 0x1c53bb6b, cue: 0xbb, cueTime: 0xb3, cuePlace: 0xb7,
  cueTrack: 0xf7, cueCluster: 0xf1, cluster: 0x1f43b675, time: 0xe7, block: 0xa3,
};
const NAME = "Carom";
const KEY_FRAME = 0x80;

/**
 * @param {{width: number, height: number, codec: string, duration: number}} facts size [pixels], the codec's name in
 *   WebM, and the length of the film [ms]
 * @param {{time: number, key: boolean, bytes: Uint8Array}[]} pictures in order, the first one a key picture; times [ms]
 * @returns {Blob}
 */
export function webm({ width, height, codec, duration }, pictures) {
  const head = element(ID.ebml, [
    number(ID.version, 1), number(ID.readVersion, 1), number(ID.longestId, 4), number(ID.longestSize, 8),
    text(ID.kind, "webm"), number(ID.kindVersion, 4), number(ID.kindReadVersion, 2),
  ]);
  const info = element(ID.info, [number(ID.scale, 1e6), real(ID.duration, duration), text(ID.muxer, NAME), text(ID.writer, NAME)]);
  const video = element(ID.video, [number(ID.width, width), number(ID.height, height)]);
  const track = [number(ID.number, 1), number(ID.uid, 1), number(ID.lacing, 0), number(ID.type, 1), text(ID.codec, codec), video];
  const tracks = element(ID.tracks, [element(ID.track, track)]);
  const clusters = clustersOf(pictures);
  // All numbers have eight bytes, so the size of the cues is known before the places of the clusters are.
  let at = info.size + tracks.size + cues(clusters.map((each) => ({ ...each, at: 0 }))).size;
  for (const each of clusters) [each.at, at] = [at, at + each.element.size];
  const segment = element(ID.segment, [info, tracks, cues(clusters), ...clusters.map((each) => each.element)]);
  return new Blob([...head.parts, ...segment.parts], { type: "video/webm" });
}

/** A cluster begins at each key picture. */
function clustersOf(pictures) {
  const groups = [];
  for (const picture of pictures) {
    if (picture.key) groups.push([]);
    groups.at(-1).push(picture);
  }
  return groups.map((group) => {
    const { time } = group[0];
    return { time, at: 0, element: element(ID.cluster, [number(ID.time, time), ...group.map((picture) => block(picture, time))]) };
  });
}

function block({ time, key, bytes }, from) {
  const header = new DataView(new ArrayBuffer(4));
  header.setUint8(0, 0x81);
  header.setInt16(1, time - from);
  header.setUint8(3, key ? KEY_FRAME : 0);
  return element(ID.block, [{ parts: [header.buffer, bytes], size: 4 + bytes.byteLength }]);
}

function cues(clusters) {
  const points = clusters.map(({ time, at }) => {
    const place = element(ID.cuePlace, [number(ID.cueTrack, 1), number(ID.cueCluster, at)]);
    return element(ID.cue, [number(ID.cueTime, time), place]);
  });
  return element(ID.cues, points);
}

/** An element of others: its bytes in parts, and how many bytes they are. */
function element(id, inner) {
  const size = inner.reduce((sum, each) => sum + each.size, 0);
  const head = new DataView(new ArrayBuffer(8));
  // The first bit of a size of eight bytes.
  head.setBigUint64(0, (1n << 56n) | BigInt(size));
  const name = idBytes(id);
  return { parts: [name, head.buffer, ...inner.flatMap((each) => each.parts)], size: name.length + 8 + size };
}

function idBytes(id) {
  const bytes = [];
  for (let rest = id; rest > 0; rest = Math.floor(rest / 256)) bytes.unshift(rest % 256);
  return new Uint8Array(bytes);
}

function leaf(id, buffer) {
  return element(id, [{ parts: [buffer], size: buffer.byteLength }]);
}

function number(id, value) {
  const view = new DataView(new ArrayBuffer(8));
  view.setBigUint64(0, BigInt(Math.round(value)));
  return leaf(id, view.buffer);
}

function real(id, value) {
  const view = new DataView(new ArrayBuffer(8));
  view.setFloat64(0, value);
  return leaf(id, view.buffer);
}

function text(id, value) {
  return leaf(id, new TextEncoder().encode(value).buffer);
}
