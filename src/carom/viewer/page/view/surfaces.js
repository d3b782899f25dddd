// The shader programs that draw surfaces: one for each set of features that is needed.

import { Program } from "./gpu.js";
import { surface } from "./shaders.js";

/** Texture unit of each sampler. */
const SAMPLERS = { image: 0, shadows: 1, reflection: 2 };

export class Surfaces {
  constructor(gl) {
    this.gl = gl;
    this.programs = new Map();
    this.begin([], {});
  }

  /** Sets the features (see `surface`) and uniforms of the surfaces drawn from now on. */
  begin(features, uniforms) {
    this.features = features;
    this.uniforms = uniforms;
    /** The programs whose uniforms are set. */
    this.programsSet = new Set();
    this.present = null;
  }

  /** Makes the program for surfaces with or without a texture the current one. */
  use(textured) {
    const program = this.program(textured ? ["TEXTURED", ...this.features] : this.features);
    if (program === this.present) return;
    program.use(this.programsSet.has(program) ? {} : this.uniforms);
    this.programsSet.add(program);
    this.present = program;
  }

  /** Notes that another program has been used in between. */
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
