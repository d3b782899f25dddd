// SpaceMice by WebHID: told to the script as gamepads with six axes.

/** @import { Gamepads } from "./gamepads.js" */

/** Vendors: 3Dconnexion, and Logitech, under whose number its older devices are. */
const FILTERS = [{ vendorId: 0x256f }, { vendorId: 0x046d, usagePage: 1, usage: 8 }];
/** Axes tell numbers up to this. */
const FULL = 350;
/** Kinds of reports. */
const [SHIFT, TURN, BUTTONS] = [1, 2, 3];
/** At least so many buttons are told. */
const FEWEST = 2;

/** The browser's HID devices; undefined where it has none, the page is not by https or from this machine, or a frame. */
function allowed() {
  const { featurePolicy } = /** @type {any} */ (document);
  return !featurePolicy || featurePolicy.allowsFeature("hid") ? /** @type {any} */ (navigator).hid : undefined;
}

export class SpaceMice {
  /**
   * @param {Gamepads} gamepads
   * @param {any} [hid] of the browser; undefined where it has none or none is allowed
   */
  constructor(gamepads, hid = allowed()) {
    this.gamepads = gamepads;
    this.hid = hid;
    /** @type {Map<any, {axes: number[], buttons: number[]}>} */
    this.known = new Map();
    if (!hid) return;
    hid.addEventListener("disconnect", ({ device }) => this.forget(device));
    hid.addEventListener("connect", ({ device }) => this.open(device));
    // Those that the user has allowed before.
    hid.getDevices().then((devices) => devices.forEach((device) => this.open(device)), () => {});
  }

  /** Lets the user choose one; it needs a click. Returns how many are there. */
  async choose() {
    const devices = await this.hid.requestDevice({ filters: FILTERS });
    for (const device of devices) await this.open(device);
    return devices.length;
  }

  async open(device) {
    if (this.known.has(device)) return;
    this.known.set(device, { axes: [0, 0, 0, 0, 0, 0], buttons: Array(FEWEST).fill(0) });
    device.addEventListener("inputreport", ({ reportId, data }) => this.take(device, reportId, data));
    if (!device.opened) await device.open();
    this.tell(device);
  }

  forget(device) {
    this.known.delete(device);
    this.gamepads.put(device, null);
  }

  /**
   * Takes a report: shifts, turns, both of newer devices, or buttons.
   *
   * @param {DataView} data
   */
  take(device, reportId, data) {
    const state = this.known.get(device);
    if (!state) return;
    if (reportId === BUTTONS) {
      const bits = [...Array(data.byteLength).keys()].flatMap((byte) => [...Array(8).keys()].map((bit) => (data.getUint8(byte) >> bit) & 1));
      const last = Math.max(bits.lastIndexOf(1) + 1, state.buttons.length, FEWEST);
      state.buttons = bits.slice(0, last);
    } else if (reportId === SHIFT || reportId === TURN) {
      const first = reportId === TURN ? 3 : 0;
      const count = Math.min(Math.floor(data.byteLength / 2), 6 - first);
      for (let i = 0; i < count; i++) state.axes[first + i] = Math.max(-1, Math.min(1, data.getInt16(2 * i, true) / FULL));
    }
    this.tell(device);
  }

  tell(device) {
    const { axes, buttons } = this.known.get(device);
    this.gamepads.put(device, { name: device.productName || "SpaceMouse", axes: [...axes], buttons: [...buttons], standard: false });
  }
}
