// Draws a scene with WebGL.

import { add, cross, multiply, orthographic, scale, unit, viewMatrix } from "./maths.js";
import { Picture, Program, ShadowMap } from "./gpu.js";
import { LineBatch } from "./line_batch.js";
import { NoGraphics } from "./no_graphics.js";
import { Outline } from "./outline.js";
import { Pace } from "./software/pace.js";
import { GRID, LINES, POINTS, SHADOW, SIGN, SKY, WIRE } from "./shaders.js";
import { SolidBatch } from "./arrows/solid_batch.js";
import { SharpLines } from "./software/sharp_lines.js";
import { StillLayer } from "./software/still_layer.js";
import { Surfaces } from "./surfaces.js";

/** @import { Options } from "../panel/options.js" */
/** @import { Solids } from "./arrows/solids.js" */
/** @import { Camera } from "./camera.js" */
/** @import { Lines } from "./lines.js" */
/** @import { Scene } from "./scene.js" */
/** @import { Sign } from "./sign.js" */
/** @import { Stage } from "./stage/stage.js" */

const GRID_EXTENT = 60;
/** Distance at which objects fade into haze [m]; at least this multiple of the camera's distance. */
const HAZE = 90;
const HAZE_BY_DISTANCE = 16;
const NO_HAZE = 1e6;
/** Maximum width of the shadow map if the CPU renders, at rest and while something moves [texels]. */
const SMALL_SHADOWS = 1024;
const MOVING_SHADOWS = 512;
/** Minimum width of lines [drawn pixels]. */
const THINNEST = 1.2;
/** Colour between several views. */
const BETWEEN = [0.55, 0.6, 0.65];

/** Whether the CPU renders, because there is no GPU: each pixel then takes time from the simulation. */
function drawnByTheProcessor() {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return false;
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : "";
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

/** The renderer of a canvas; in a browser without WebGL 2 one that draws nothing. */
export function rendererFor(canvas) {
  const slow = drawnByTheProcessor();
  const gl = canvas.getContext("webgl2", { alpha: false, antialias: !slow, powerPreference: "high-performance" });
  return gl ? new Renderer(canvas, gl, slow) : new NoGraphics();
}

class Renderer {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {boolean} slow whether the CPU renders
   */
  constructor(canvas, gl, slow) {
    this.canvas = canvas;
    this.gl = gl;
    /** Whether the WebGL context is lost; a restored context has none of the objects made here. */
    this.lost = false;
    canvas.addEventListener("webglcontextlost", () => (this.lost = true));
    this.surfaces = new Surfaces(gl);
    this.shadow = new Program(gl, SHADOW);
    this.wire = new Program(gl, WIRE);
    this.sky = new Program(gl, SKY);
    this.grid = new Program(gl, GRID);
    this.lines = new Program(gl, LINES);
    this.points = new Program(gl, POINTS);
    this.sign = new Program(gl, SIGN);
    this.nothing = gl.createVertexArray();
    this.lineBatch = new LineBatch(gl);
    this.solidBatch = new SolidBatch(gl, slow);
    this.map = new ShadowMap(gl, 2048);
    this.reflection = new Picture(gl);
    /** What does not move, for each view. @type {StillLayer[]} */
    this.layers = [];
    this.outline = new Outline(gl, this.wire);
    this.byProcessor = slow;
    this.pace = new Pace(slow);
    this.sharpLines = new SharpLines(canvas);
    /** The view that is drawn. */
    this.view = { number: 0, x: 0, y: 0, width: 1, height: 1 };
  }

  /** Fits the canvas to the window; true if its size has changed. */
  resize() {
    const ratio = Math.min(window.devicePixelRatio, 2) * this.pace.sharpness;
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.canvas.width === width && this.canvas.height === height) return false;
    this.canvas.width = width;
    this.canvas.height = height;
    return true;
  }

  /** Begins a picture of several views: what lies between them gets a colour. */
  begin() {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.clearColor(BETWEEN[0], BETWEEN[1], BETWEEN[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.clearColor(0, 0, 0, 0);
  }

  /**
   * Draws a view.
   *
   * @param {Scene} scene
   * @param {Camera} camera
   * @param {Options} options
   * @param {{stage: Stage, lines: Lines, solids: Solids, clouds: object[], signs: Sign[], selected: object}} drawings
   *   lights and sky of files, and what is drawn over the scene; `selected` is the body that has an outline, undefined for none
   * @param {{number: number, x: number, y: number, width: number, height: number}} view which one, and its part of the canvas
   *   from the lower left corner on [drawn pixels]
   */
  draw(scene, camera, options, drawings, view) {
    const { gl } = this;
    this.view = view;
    const layer = (this.layers[view.number] ??= new StillLayer(gl));
    scene.regroup(options);
    this.stage = drawings.stage;
    // If the CPU renders, details are left out while something moves.
    const detailed = !this.byProcessor || this.pace.still;
    const window = detailed ? null : this.changedPart(layer, scene, camera, options, drawings);
    const focal = view.height / 2;
    const world = (aim) => this.drawWorld(scene, camera, options, detailed, aim);
    if (window && !layer.made) {
      scene.fill(options, camera.eye, focal, true);
      layer.keep(view, world);
    }
    scene.fill(options, camera.eye, focal);
    const covered = window && layer.covered(drawings, camera, view);
    if (window) layer.compose(window, covered, view, world);
    else world(() => this.aimAtCanvas());
    gl.enable(gl.DEPTH_TEST);
    this.drawSigns(drawings.signs, scene, camera);
    if (!options.wireframe) this.drawClear(scene, camera, options);
    this.drawPoints(drawings.clouds, scene, camera);
    this.drawLines(drawings.lines, camera);
    this.solidBatch.draw(drawings.solids, camera, covered);
    const into = window ? { target: layer.present.target, x: 0, y: 0, width: view.width, height: view.height } : { target: null, ...view };
    this.outline.draw(scene, camera, options, drawings.selected, into);
    gl.disable(gl.DEPTH_TEST);
    if (window) layer.show(view);
  }

  /** The part of the view in which something moves, see `StillLayer.window`; null to draw everything. */
  changedPart(layer, scene, camera, options, drawings) {
    if (options.wireframe || options.reflections || drawings.signs.length > 0 || drawings.stage.moves) return null;
    const shadows = options.shadows && !options.flat;
    if (shadows) this.sizeShadows(options, false);
    const light = this.light(camera, options);
    return layer.window(scene, camera, options, this.view, light.direction, shadows ? light.texel : 0);
  }

  aimAtCanvas() {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const { x, y, width, height } = this.view;
    gl.viewport(x, y, width, height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
  }

  shown(scene, options) {
    return scene.groups.filter((group) => group.instances > 0 && options.shows(group));
  }

  /** Draws surfaces, sky and grid; `aim` is called before these to set the target, after shadows and reflections. */
  drawWorld(scene, camera, options, detailed, aim) {
    const gl = this.gl;
    const shown = this.shown(scene, options);
    const { flat } = options;
    const shadows = options.shadows && !options.wireframe && !flat;
    if (shadows) this.sizeShadows(options, detailed);
    const staged = this.stage.lit && !flat ? this.stage.shading(camera) : null;
    const light = this.light(camera, options);
    if (shadows) this.drawShadows(shown, light);
    const mirror = options.reflections || !detailed || camera.yUp ? null : this.stage.mirror;
    const reflecting = (options.reflections || mirror !== null) && !options.wireframe && !flat;
    const shading = {
      toLight: light.direction,
      lightCamera: light.matrix,
      shadowStrength: staged ? Number(staged.shadow) : options.shadowIntensity,
      mirrorLevel: mirror?.height ?? 0,
      mirrorShare: mirror?.share ?? -1,
      ...staged?.uniforms,
      shadowTexel: 1 / this.map.size,
      shadowBias: (light.extent / this.map.size) * 0.04 + 2e-5,
    };
    const lit = [staged && "STAGED", shadows && "SHADOWED", ...(detailed ? ["SOFT", "GLOSSY"] : [!reflecting && "QUICK"])];
    const features = flat ? ["FLAT", options.depth && "DEPTH"].filter(Boolean) : lit.filter(Boolean);
    if (reflecting) this.drawReflection(shown, scene, camera.mirrored(mirror?.height ?? 0), options, shading, features);
    aim();
    const common = this.seenFrom(camera, options);
    const { x, y, width, height } = this.view;
    gl.enable(gl.DEPTH_TEST);
    if (options.wireframe) this.drawWires(shown, camera);
    else {
      if (reflecting) features.push("MIRRORING");
      this.surfaces.begin(features, { ...common, ...shading, reflectionSize: [width, height], reflectionCorner: [x, y] });
      this.plain = flat;
      this.drawSurfaces(shown, scene, reflecting ? this.reflection.texture : null);
    }
    this.drawSky(camera, common);
    if (options.grid && !flat) this.drawGrid(camera, common);
  }

  /** Uniforms that all programs need for a view. */
  seenFrom(camera, options) {
    return {
      eye: camera.eye,
      upward: camera.yUp ? [0, 1, 0] : [0, 0, 1],
      backdrop: options.flat ? [1, 1, 1] : (options.background ?? [0, 0, 0]),
      plainBackdrop: options.flat || options.background ? 1 : 0,
      focus: camera.distance,
      haze: this.stage.hazy ? Math.max(HAZE, camera.distance * HAZE_BY_DISTANCE) : NO_HAZE,
      camera: camera.matrix,
    };
  }

  /** Draws the reflection in the ground into a texture. */
  drawReflection(groups, scene, mirrored, options, shading, features) {
    const gl = this.gl;
    this.reflection.begin(this.view.width, this.view.height);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const common = this.seenFrom(mirrored, options);
    gl.enable(gl.DEPTH_TEST);
    // Mirroring reverses the winding order of triangles.
    gl.frontFace(gl.CW);
    this.surfaces.begin([...features, "ABOVE_GROUND"], { ...common, ...shading });
    this.drawSurfaces(groups, scene, null);
    gl.frontFace(gl.CCW);
    // What files say that mirrors adds the light of things, not that of the sky.
    if (shading.mirrorShare < 0) this.drawSky(mirrored, common);
  }

  /** Draws opaque surfaces. */
  drawSurfaces(groups, scene, reflection) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.map.texture);
    gl.activeTexture(gl.TEXTURE2);
    gl.bindTexture(gl.TEXTURE_2D, reflection);
    for (const group of groups) if (!group.clear) this.drawSolid(group, scene);
  }

  light(camera, options) {
    const direction = this.stage.lit ? this.stage.shading(camera).towards : unit(options.lightPosition);
    const side = unit(cross(Math.abs(direction[2]) < 0.99 ? [0, 0, 1] : [1, 0, 0], direction));
    const up = cross(direction, side);
    const extent = options.shadowWorldSize ?? Math.min(60, Math.max(0.5, camera.reach * 1.6));
    // The shadow map moves in whole texels, so that edges of shadows do not flicker when the camera moves.
    const texel = (2 * extent) / this.map.size;
    const centre = add(camera.centre, scale(camera.forward, Math.min(0, extent - camera.reach)));
    const snapped = [side, up].map((axis) => {
      const along = axis[0] * centre[0] + axis[1] * centre[1] + axis[2] * centre[2];
      return scale(axis, Math.round(along / texel) * texel - along);
    });
    const reach = 4 * extent + 10;
    const eye = add(add(add(centre, snapped[0]), snapped[1]), scale(direction, reach));
    const view = viewMatrix(eye, side, up, scale(direction, -1));
    return { direction, texel, extent: extent / reach, matrix: multiply(orthographic(extent, 0, 2 * reach), view) };
  }

  /** Replaces the shadow map if another size is needed. */
  sizeShadows(options, detailed) {
    const most = this.byProcessor ? (detailed ? SMALL_SHADOWS : MOVING_SHADOWS) : Infinity;
    const wanted = Math.min(options.shadowResolution, most);
    if (this.map.wanted === wanted) return;
    this.map.dispose();
    this.map = new ShadowMap(this.gl, wanted);
  }

  drawShadows(groups, light) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.map.target);
    gl.viewport(0, 0, this.map.size, this.map.size);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1.5, 2);
    this.shadow.use({ camera: light.matrix });
    for (const group of groups) {
      if (!group.clear) this.drawGroup(group);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  /** Draws the sky where nothing else has been drawn. */
  drawSky(camera, common) {
    const gl = this.gl;
    gl.depthFunc(gl.LEQUAL);
    gl.bindVertexArray(this.nothing);
    const [forward, rightward, overhead] = camera.spread;
    const image = common.plainBackdrop ? undefined : this.stage.sky;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, image ?? null);
    this.sky.use({ ...common, forward, rightward, overhead, skyShown: image ? 1 : 0, stageHaze: this.stage.haze, hazeShown: this.stage.hazy ? 1 : 0 });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.depthFunc(gl.LESS);
  }

  drawGroup(group) {
    const gl = this.gl;
    if (group.twoSided) gl.disable(gl.CULL_FACE);
    else gl.enable(gl.CULL_FACE);
    group.draw();
    gl.disable(gl.CULL_FACE);
  }

  drawSolid(group, scene) {
    const gl = this.gl;
    const texture = scene.textures.get(group.texture);
    this.surfaces.use(texture !== undefined && !this.plain);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture ?? null);
    this.drawGroup(group);
  }

  drawClear(scene, camera, options) {
    const gl = this.gl;
    const clear = this.shown(scene, options).filter((group) => group.clear);
    if (clear.length === 0) return;
    const depth = (group) => group.middle.reduce((sum, x, i) => sum + (x - camera.eye[i]) * camera.forward[i], 0);
    clear.sort((a, b) => depth(b) - depth(a));
    this.surfaces.interrupted();
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    for (const group of clear) this.drawSolid(group, scene);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  drawWires(groups, camera) {
    this.wire.use({ camera: camera.matrix });
    for (const group of groups) group.drawEdges();
  }

  drawGrid(camera, common) {
    const gl = this.gl;
    const extent = Math.max(GRID_EXTENT, camera.distance * 8);
    const [across, along] = camera.yUp ? [[1, 0, 0], [0, 0, 1]] : [[1, 0, 0], [0, 1, 0]];
    const centre = camera.eye.map((x, i) => x * (across[i] + along[i]));
    this.grid.use({ ...common, centre, across, along, extent });
    gl.bindVertexArray(this.nothing);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    // The offset lets a floor at the same height cover the grid.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(2, 8);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  drawLines(lines, camera) {
    const sharp = this.pace.coarse;
    if (sharp) this.sharpLines.draw(lines, camera, this.view.number === 0);
    else this.sharpLines.clear();
    if (lines.count === 0) return;
    // A line that is thinner than the pixels that are drawn would consist of dots.
    const thinnest = Math.max(1, (THINNEST * camera.width) / this.view.width);
    this.lines.use({ camera: camera.matrix, pixels: [camera.width, camera.height], thinnest });
    this.lineBatch.draw(lines, sharp ? lines.outside : lines.count);
  }

  drawSigns(signs, scene, camera) {
    const gl = this.gl;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.bindVertexArray(this.nothing);
    gl.activeTexture(gl.TEXTURE0);
    for (const sign of signs) {
      const edges = sign.edges(scene);
      if (edges === null) continue;
      this.sign.use({ camera: camera.matrix, ...edges });
      gl.bindTexture(gl.TEXTURE_2D, sign.texture);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
    gl.disable(gl.BLEND);
  }

  drawPoints(clouds, scene, camera) {
    const gl = this.gl;
    const ratio = this.view.width / camera.width;
    for (const cloud of clouds) {
      const axes = cloud.axes(scene);
      if (axes === null) continue;
      const [axisX, axisY, axisZ, origin] = axes;
      this.points.use({ camera: camera.matrix, axisX, axisY, axisZ, origin, size: Math.max(1, cloud.size * ratio) });
      gl.bindVertexArray(cloud.array);
      gl.drawArrays(gl.POINTS, 0, cloud.count);
    }
  }
}
