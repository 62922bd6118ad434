// The scene: what the state asks for, drawn with three.js; the camera; which facet lies under the pointer.
// Coordinates are moved and scaled so that the mesh fills the unit ball: single precision then always suffices.

import { Group, PerspectiveCamera, Scene, Vector3, WebGLRenderer, WebGLRenderTarget, type Mesh, ColorManagement, LinearSRGBColorSpace } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { category, onScale, sample, valueColour } from "./colour";
import type { MeshData, Rgb, Values } from "./data";
import { Facets, sheetSurface } from "./facets";
import { boundaryWire, chordCurves, segments, singularEdges } from "./lines";
import type { ViewState } from "./state";
import { EDGES, facetVertices, type Topology } from "./topology";

const TOWARDS_EYE = new Vector3(1, -1.9, 1.05).normalize();
const HALF_ANGLE = (15 * Math.PI) / 180;

/** Whether hexes are drawn at all. */
export function hexesShown(s: ViewState): boolean {
  return s.boundary !== "xray" && !(s.sheet !== null && s.sheetAs === "surface");
}

export class Viewer {
  readonly camera = new PerspectiveCamera((2 * HALF_ANGLE * 180) / Math.PI, 1, 0.01, 100);
  readonly controls: OrbitControls;
  /** Positions in the unit ball, 3 a vertex. */
  readonly points: Float32Array;
  readonly drawable: Uint8Array;
  /** Hexes in the order of the animation, and the place of each in it. */
  readonly order: Uint32Array;
  readonly place: Uint32Array;
  shown = 0;
  onRender = () => {};
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly pickScene = new Scene();
  private readonly pickTarget = new WebGLRenderTarget(1, 1);
  private readonly facets: Facets;
  private readonly overlays = new Map<string, { key: string; objects: Group }>();
  private readonly wire: LineSegments2 | null;
  /** The corners of the boundary that can be drawn, each a vertex and its hex. */
  private readonly outline: [number, number][] = [];
  private state: ViewState | null = null;
  private visible: Uint8Array;
  private dirty = false;
  private dark = false;
  /** Direction of the last fit, until the user moves the camera: a new window size fits again. */
  private fitted: Vector3 | null = null;

  /** Throws if the browser gives no WebGL 2. */
  constructor(private readonly canvas: HTMLCanvasElement, private readonly data: MeshData, private readonly t: Topology) {
    ColorManagement.enabled = false;
    const context = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true });
    if (!context) throw new Error("this browser or machine offers no WebGL 2");
    this.renderer = new WebGLRenderer({ canvas, context });
    this.renderer.debug.onShaderError = (gl, _program, vertex, fragment) => {
      throw new Error(`a shader does not compile: ${gl.getShaderInfoLog(vertex)} ${gl.getShaderInfoLog(fragment)}`);
    };
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setClearColor(0, 0);

    this.drawable = new Uint8Array(data.hexes);
    for (let h = 0; h < data.hexes; h++) this.drawable[h] = Number(this.cornerCoordinates(data.points, h).every(Number.isFinite));
    this.points = this.inUnitBall();
    this.order = data.shelling ?? Uint32Array.from({ length: data.hexes }, (_, h) => h);
    this.place = new Uint32Array(data.hexes);
    this.order.forEach((h, i) => (this.place[h] = i));
    this.visible = new Uint8Array(data.hexes);

    this.facets = new Facets(t, this.points, this.drawable, data.colours.surface, data.colours.inside, data.groups);
    const wire = boundaryWire(t, this.points);
    this.wire = wire.length > 0 ? segments(wire, { width: 1, opacity: 0.55 }) : null;
    this.scene.add(this.facets.solid, this.facets.glass);
    if (this.wire) this.scene.add(this.wire);
    this.pickScene.add(this.facets.pick);

    for (const f of t.boundaryFacets) {
      const h = Math.floor(f / 6);
      if (this.drawable[h]) this.outline.push(...facetVertices(t.corners, f).map((v): [number, number] => [v, h]));
    }
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.minDistance = 0.05;
    this.controls.maxDistance = 60;
    this.controls.addEventListener("change", () => this.request());
    this.controls.addEventListener("start", () => (this.fitted = null));
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
    this.fit(TOWARDS_EYE);
  }

  private cornerCoordinates(points: ArrayLike<number>, h: number): number[] {
    return Array.from(this.data.corners.subarray(8 * h, 8 * h + 8)).flatMap((v) => [points[3 * v], points[3 * v + 1], points[3 * v + 2]]);
  }

  private inUnitBall(): Float32Array {
    const { points, corners, hexes } = this.data;
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let h = 0; h < hexes; h++) {
      if (!this.drawable[h]) continue;
      for (let i = 0; i < 8; i++) {
        for (let c = 0; c < 3; c++) {
          const x = points[3 * corners[8 * h + i] + c];
          low[c] = Math.min(low[c], x);
          high[c] = Math.max(high[c], x);
        }
      }
    }
    const radius = 0.5 * Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    const scale = radius > 0 && Number.isFinite(radius) ? 1 / radius : 1;
    return Float32Array.from(points, (x, i) => (x - 0.5 * (low[i % 3] + high[i % 3])) * scale);
  }

  /** Shows `state`; only what changed is made anew. */
  apply(state: ViewState, dark: boolean): void {
    const uniforms = this.facets.uniforms;
    uniforms.shrink.value = state.shrink;
    uniforms.explode.value = state.explode;
    uniforms.picked.value = state.picked ?? -1;
    uniforms.byGroup.value = state.colour === "group" && this.data.groups !== null;
    this.dark = dark;
    uniforms.lineColour.value.setScalar(dark ? 0.07 : 0.16);
    uniforms.opacity.value = dark ? 0.13 : 0.17;
    this.facets.glass.visible = state.boundary === "glass" || state.boundary === "xray";
    if (this.wire) {
      this.wire.visible = state.boundary !== "none";
      this.wire.material.color.set(dark ? 0x8fa0b0 : 0x51606e);
    }
    this.state = state;
    this.chooseVisible(state);
    this.facets.solid.visible = this.facets.pick.visible = hexesShown(state);
    this.shown = this.facets.show(this.visible, state.shrink < 1 || state.explode > 0);
    const values = this.data.values && onScale(this.data.values, state.scale);
    this.facets.colour((h) => this.colourOf(h, state, values));
    const { t, points } = this;

    this.overlay("singular", state.singular, () => {
      const { coordinates, colours } = singularEdges(t, points, state.singular === "all");
      // Drawn twice: faintly through everything, and in full where nothing lies in front.
      return coordinates.length === 0 || state.singular === "none"
        ? []
        : [segments(coordinates, { width: 3, opacity: 0.45, onTop: true }, colours), segments(coordinates, { width: 4.5 }, colours)];
    });
    this.overlay("chord", String(state.chord), () => {
      if (state.chord === null) return [];
      const { coordinates, colours } = chordCurves(t, points, state.chord);
      return coordinates.length === 0
        ? []
        : [segments(coordinates, { width: 3, opacity: 0.25, onTop: true }, colours), segments(coordinates, { width: 4 }, colours)];
    });
    const surface = state.sheet !== null && state.sheetAs === "surface";
    // The surfaces are cut, peeled and built up like the hexes.
    const { sheet, normal, cut, flip, peel, limit, hidden } = state;
    this.overlay("sheet", surface ? JSON.stringify([sheet, normal, cut, flip, peel, limit, state.shown, state.column, hidden]) : "", () => {
      const chosen = sheet === "all" ? t.sheets.map((_, i) => i) : [sheet as number];
      return surface ? [sheetSurface(t, points, this.visible, chosen.map((sheet) => ({ sheet, colour: category(sheet) })))] : [];
    });
    this.overlay("picked", `${state.picked} ${state.shrink} ${state.explode}`, () => {
      if (state.picked === null || !this.drawable[state.picked]) return [];
      const at = this.placedCorners(state.picked);
      const coordinates = EDGES.flatMap(([a, b]) => [...at[a].toArray(), ...at[b].toArray()]);
      return [segments(coordinates, { width: 2, colour: dark ? 0x8cc8ff : 0x0b62b8, opacity: 0.9, onTop: true })];
    });
    this.request();
  }

  private overlay(name: string, key: string, make: () => (Mesh | LineSegments2)[]): void {
    const old = this.overlays.get(name);
    if (old?.key === key) return;
    old?.objects.traverse((o) => {
      const mesh = o as Mesh;
      mesh.geometry?.dispose();
      (mesh.material as { dispose?: () => void } | undefined)?.dispose?.();
    });
    old?.objects.removeFromParent();
    const objects = new Group();
    for (const o of make()) objects.add(o);
    this.scene.add(objects);
    this.overlays.set(name, { key, objects });
  }

  /** Least and greatest place of the hex centres along a normal. */
  extent(normal: readonly number[]): [number, number] {
    let low = Infinity;
    let high = -Infinity;
    for (let h = 0; h < this.data.hexes; h++) {
      if (!this.drawable[h]) continue;
      const x = this.along(normal, h);
      low = Math.min(low, x);
      high = Math.max(high, x);
    }
    return [low, high];
  }

  private along(normal: readonly number[], h: number): number {
    const c = this.facets.centres;
    return normal[0] * c[4 * h] + normal[1] * c[4 * h + 1] + normal[2] * c[4 * h + 2];
  }

  private chooseVisible(s: ViewState): void {
    const { t, data } = this;
    const [low, high] = this.extent(s.normal);
    const hide = new Set(s.hidden);
    for (let h = 0; h < data.hexes; h++) {
      const x = this.along(s.normal, h);
      const away = (s.flip ? x - low : high - x) < s.cut * (high - low) - 1e-6;
      const sheet = typeof s.sheet !== "number" || s.sheetAs !== "hexes" || this.sheetsOf(h).includes(s.sheet);
      const column = s.column === null || this.columnsOf(h).includes(s.column);
      const value = s.limit === null || !data.values || !(data.values.data[h] > s.limit);
      const built = s.shown === null || this.place[h] < s.shown;
      this.visible[h] = Number(this.drawable[h] === 1 && !away && sheet && column && value && built && t.layer[h] >= s.peel && !hide.has(h));
    }
  }

  private colourOf(h: number, s: ViewState, values: Values | null): Rgb | null {
    const { colours } = this.data;
    if (s.shown !== null && s.shown < this.data.hexes && this.place[h] === s.shown - 1) return [255, 140, 30];
    if (typeof s.sheet === "number" && s.sheetAs === "place" && this.sheetsOf(h).includes(s.sheet)) return category(s.sheet);
    if (s.colour === "value" && values) return valueColour(values, values.data[h], colours.unknown, colours.flagged);
    if (s.colour === "layer") return sample(colours.growth, this.t.layers > 1 ? this.t.layer[h] / (this.t.layers - 1) : 0.5);
    if (s.colour === "order") return sample(colours.growth, this.data.hexes > 1 ? this.place[h] / (this.data.hexes - 1) : 0.5);
    if (typeof s.sheet === "number" && s.sheetAs === "hexes") return category(s.sheet);
    return null;
  }

  sheetsOf(h: number): number[] {
    return [...new Set(this.t.sheetOf.subarray(3 * h, 3 * h + 3))];
  }

  columnsOf(h: number): number[] {
    return [...new Set(this.t.columnOf.subarray(3 * h, 3 * h + 3))];
  }

  /** The corners of a hex where they are drawn now. */
  placedCorners(h: number): Vector3[] {
    const centre = new Vector3().fromArray(this.facets.centres, 4 * h);
    const { shrink, explode } = this.state!;
    return Array.from(this.data.corners.subarray(8 * h, 8 * h + 8), (v) =>
      this.vertex(v).sub(centre).multiplyScalar(shrink).addScaledVector(centre, 1 + explode),
    );
  }

  vertex(v: number): Vector3 {
    return new Vector3().fromArray(this.points, 3 * v);
  }

  /** Pixels from the top left of the canvas, or null behind the eye. */
  onScreen(p: Vector3): [number, number] | null {
    const q = p.clone().project(this.camera);
    if (q.z > 1) return null;
    return [(0.5 + 0.5 * q.x) * this.canvas.clientWidth, (0.5 - 0.5 * q.y) * this.canvas.clientHeight];
  }

  hover(hex: number): void {
    if (this.facets.uniforms.hovered.value === hex) return;
    this.facets.uniforms.hovered.value = hex;
    this.request();
  }

  /** The facet drawn at a place of the canvas (pixels from its top left), or -1. */
  facetAt(x: number, y: number): number {
    const { camera, renderer } = this;
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    camera.setViewOffset(width, height, Math.floor(x), Math.floor(y), 1, 1);
    renderer.setRenderTarget(this.pickTarget);
    renderer.clear();
    renderer.render(this.pickScene, camera);
    const b = new Uint8Array(4);
    renderer.readRenderTargetPixels(this.pickTarget, 0, 0, 1, 1, b);
    renderer.setRenderTarget(null);
    camera.clearViewOffset();
    return (b[0] | (b[1] << 8) | (b[2] << 16) | (b[3] << 24)) - 1;
  }

  /** Looks at the mesh from `direction` (default: the present one), as near as everything drawn allows. */
  fit(direction?: Vector3): void {
    const from = (direction ?? this.camera.position.clone().sub(this.controls.target)).clone().normalize();
    const right = new Vector3(-from.y, from.x, 0).normalize();
    const up = from.clone().cross(right);
    const explode = this.state?.explode ?? 0;
    const vertical = 0.87 * Math.tan(HALF_ANGLE);
    const horizontal = 0.92 * Math.tan(HALF_ANGLE) * this.camera.aspect;
    // A point at (r, u, f) in the camera's axes is in sight if |r - r0| <= horizontal * (distance - f), likewise u;
    // each bound is a line in (place of the target, distance), so the extremes of r + t f and r - t f decide.
    const most = [-Infinity, -Infinity, -Infinity, -Infinity];
    for (const [v, h] of this.outline) {
      const p = this.vertex(v).addScaledVector(new Vector3().fromArray(this.facets.centres, 4 * h), explode);
      const [r, u, f] = [p.dot(right), p.dot(up), p.dot(from)];
      [r / horizontal + f, -r / horizontal + f, u / vertical + f, -u / vertical + f].forEach((x, i) => (most[i] = Math.max(most[i], x)));
    }
    const distance = Math.max(0.5 * (most[0] + most[1]), 0.5 * (most[2] + most[3]), 0.2);
    const target = right.multiplyScalar(0.5 * (most[0] - most[1]) * horizontal).addScaledVector(up, 0.5 * (most[2] - most[3]) * vertical);
    if (!target.toArray().every(Number.isFinite) || !Number.isFinite(distance)) return;
    this.controls.target.copy(target);
    this.fitted = from.clone();
    this.camera.position.copy(from.multiplyScalar(distance)).add(target);
    this.controls.update();
    this.request();
  }

  lookAlong(axis: number): void {
    // Just off the pole, so that x points right and y up when one looks down z.
    this.fit(axis === 0 ? new Vector3(1, 0, 0) : axis === 1 ? new Vector3(0, -1, 0) : new Vector3(0, -1e-4, 1));
  }

  home(): void {
    this.fit(TOWARDS_EYE);
  }

  turn(right: number, up: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const polar = Math.acos(offset.z / offset.length());
    offset.applyAxisAngle(new Vector3(0, 0, 1), right);
    const side = new Vector3(-offset.y, offset.x, 0).normalize();
    offset.applyAxisAngle(side, -Math.min(Math.max(up, polar - Math.PI + 1e-3), polar - 1e-3));
    this.camera.position.copy(this.controls.target).add(offset);
    this.moved();
  }

  move(right: number, up: number): void {
    const step = this.camera.position.distanceTo(this.controls.target) * Math.tan(HALF_ANGLE);
    const shift = new Vector3().setFromMatrixColumn(this.camera.matrix, 0).multiplyScalar(right * step);
    shift.addScaledVector(new Vector3().setFromMatrixColumn(this.camera.matrix, 1), up * step);
    this.controls.target.add(shift);
    this.camera.position.add(shift);
    this.moved();
  }

  zoom(factor: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.setLength(Math.min(Math.max(offset.length() * factor, this.controls.minDistance), this.controls.maxDistance));
    this.camera.position.copy(this.controls.target).add(offset);
    this.moved();
  }

  lookAt(p: Vector3): void {
    const shift = p.clone().sub(this.controls.target);
    this.controls.target.add(shift);
    this.camera.position.add(shift);
    this.moved();
  }

  private moved(): void {
    this.fitted = null;
    this.controls.update();
    this.request();
  }

  get cameraNumbers(): number[] {
    return [...this.camera.position.toArray(), ...this.controls.target.toArray(), ...this.camera.up.toArray()];
  }

  set cameraNumbers(n: number[]) {
    this.camera.position.fromArray(n, 0);
    this.controls.target.fromArray(n, 3);
    this.moved();
  }

  /** The picture on the screen as a PNG, on its background. */
  async picture(top: string, bottom: string): Promise<Blob> {
    this.render();
    const copy = document.createElement("canvas");
    copy.width = this.canvas.width;
    copy.height = this.canvas.height;
    const draw = copy.getContext("2d")!;
    const ground = draw.createLinearGradient(0, 0, 0, copy.height);
    ground.addColorStop(0, top);
    ground.addColorStop(1, bottom);
    draw.fillStyle = ground;
    draw.fillRect(0, 0, copy.width, copy.height);
    draw.drawImage(this.canvas, 0, 0);
    return new Promise((done, fail) => copy.toBlob((b) => (b ? done(b) : fail(new Error("the browser made no picture"))), "image/png"));
  }

  request(): void {
    if (this.dirty) return;
    this.dirty = true;
    requestAnimationFrame(() => this.render());
  }

  private resize(): void {
    const width = Math.max(1, this.canvas.clientWidth);
    const height = Math.max(1, this.canvas.clientHeight);
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.facets.uniforms.lineWidth.value = 0.7 * Math.min(window.devicePixelRatio, 2);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.fitted) this.fit(this.fitted);
    this.request();
  }

  private render(): void {
    this.dirty = false;
    const distance = this.camera.position.length();
    const reach = 1.2 * (1 + (this.state?.explode ?? 0));
    this.camera.near = Math.max(distance - reach, 0.01);
    this.camera.far = distance + reach;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    this.onRender();
  }

  get isDark(): boolean {
    return this.dark;
  }
}
