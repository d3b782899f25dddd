// The programs that draw surfaces: one for each set of features that is needed.

import { Program } from "./gpu.js";
import { surface } from "./shaders.js";

/** Which unit each sampler takes its texture from. */
const SAMPLERS = { image: 0, shadows: 1, reflection: 2 };

export class Surfaces {
  constructor(gl) {
    this.gl = gl;
    this.programs = new Map();
    this.begin([], {});
  }

  /** From now on surfaces have these features (see `surface`) and uniforms. */
  begin(features, uniforms) {
    this.features = features;
    this.uniforms = uniforms;
    /** The programs that have been told the uniforms. */
    this.told = new Set();
    this.present = null;
  }

  /** Makes the program for textured surfaces, or for others, the present one. */
  use(textured) {
    const program = this.program(textured ? ["TEXTURED", ...this.features] : this.features);
    if (program === this.present) return;
    program.use(this.told.has(program) ? {} : this.uniforms);
    this.told.add(program);
    this.present = program;
  }

  /** Another program has been used in between. */
  interrupted() {
    this.present = null;
  }

  program(features) {
    const key = features.join();
    let program = this.programs.get(key);
    if (!program) {
      program = new Program(this.gl, surface(features));
      for (const [name, unit] of Object.entries(SAMPLERS)) program.sampler(name, unit);
      this.programs.set(key, program);
    }
    return program;
  }
}
