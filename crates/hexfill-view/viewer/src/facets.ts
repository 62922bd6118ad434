// Facets and sheet surfaces as WebGL geometry.

import {
  BufferAttribute, BufferGeometry, DataTexture, DoubleSide, FloatType, GLSL3, Mesh, NearestFilter, RGBAFormat,
  ShaderMaterial, UnsignedByteType, Vector3,
} from "three";
import type { Groups, Rgb } from "./data";
import { facetVertices, type Topology } from "./topology";
import { GLASS_FRAGMENT, HEX_FRAGMENT, HEX_VERTEX, PICK_FRAGMENT, SHEET_FRAGMENT, SHEET_VERTEX, TEXTURE_WIDTH } from "./shaders";

/** The four triangles of a facet: two neighbouring corners and the centre. */
const FAN = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];

export class Facets {
  readonly solid: Mesh;
  readonly glass: Mesh;
  readonly pick: Mesh;
  readonly centres: Float32Array;
  private readonly paintTexture: DataTexture;
  readonly paint: Uint8Array;
  private readonly index: BufferAttribute;

  /** `points` are centred and scaled; hexes with `drawable[h] = 0` never appear. */
  constructor(private readonly t: Topology, points: Float32Array, private readonly drawable: Uint8Array, surface: Rgb, inside: Rgb, groups: Groups | null) {
    const n = 6 * t.hexes;
    const position = new Float32Array(15 * n);
    const bent = new Int8Array(20 * n);
    for (let f = 0; f < n; f++) {
      if (drawable[Math.floor(f / 6)]) fillQuad(facetVertices(t.corners, f).map((v) => 3 * v), points, position, bent, f, t.glued[f] < 0);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(position, 3));
    geometry.setAttribute("bent", new BufferAttribute(bent, 4, true));
    if (groups) {
      const tint = new Uint8Array(20 * n);
      groups.facets.forEach((f, i) => {
        for (let k = 0; k < 5; k++) tint.set([...groups.colours[groups.of[i]], 255], 20 * f + 4 * k);
      });
      geometry.setAttribute("tint", new BufferAttribute(tint, 4, true));
    }
    this.index = new BufferAttribute(new Uint32Array(FAN.length * n), 1);
    geometry.setIndex(this.index);

    const rows = Math.max(1, Math.ceil(t.hexes / TEXTURE_WIDTH));
    const centres = new Float32Array(4 * TEXTURE_WIDTH * rows);
    for (let h = 0; h < t.hexes; h++) {
      for (let c = 0; c < 3; c++) {
        let sum = 0;
        for (let i = 0; i < 8; i++) sum += points[3 * t.corners[8 * h + i] + c];
        centres[4 * h + c] = sum / 8;
      }
    }
    this.centres = centres;
    this.paint = new Uint8Array(4 * TEXTURE_WIDTH * rows);
    this.paintTexture = texture(this.paint, rows, UnsignedByteType);
    const uniforms = {
      centres: { value: texture(centres, rows, FloatType) },
      paint: { value: this.paintTexture },
      middle: { value: new Vector3() },
      shrink: { value: 1 },
      explode: { value: 0 },
      surfaceColour: { value: vector(surface) },
      insideColour: { value: vector(inside) },
      byGroup: { value: false },
      lineColour: { value: new Vector3() },
      lineWidth: { value: 0.9 },
      hovered: { value: -1 },
      picked: { value: -1 },
      accent: { value: new Vector3(0.1, 0.5, 0.95) },
      opacity: { value: 0.16 },
    };
    const material = (fragmentShader: string, more: object) =>
      new ShaderMaterial({ glslVersion: GLSL3, vertexShader: HEX_VERTEX, fragmentShader, uniforms, side: DoubleSide, ...more });
    const pushed = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 };
    this.solid = still(new Mesh(geometry, material(HEX_FRAGMENT, pushed)));
    this.pick = still(new Mesh(geometry, material(PICK_FRAGMENT, {})));

    const shell = new BufferGeometry();
    shell.setAttribute("position", geometry.getAttribute("position"));
    shell.setAttribute("bent", geometry.getAttribute("bent"));
    const boundary = t.boundaryFacets.filter((f) => drawable[Math.floor(f / 6)]);
    shell.setIndex(new BufferAttribute(Uint32Array.from(boundary.flatMap((f) => FAN.map((k) => 5 * f + k))), 1));
    const fixed = { ...uniforms, shrink: { value: 1 }, explode: { value: 0 } };
    const glass = material(GLASS_FRAGMENT, { transparent: true, depthWrite: false });
    glass.uniforms = fixed;
    this.glass = still(new Mesh(shell, glass));
    this.glass.renderOrder = 2;
  }

  get uniforms() {
    return (this.solid.material as ShaderMaterial).uniforms;
  }

  /** Shows exactly the hexes with `visible[h] = 1`; facets between two of them only if `open`. Returns how many are shown. */
  show(visible: Uint8Array, open: boolean): number {
    const { glued, hexes } = this.t;
    const out = this.index.array as Uint32Array;
    let at = 0;
    let count = 0;
    for (let h = 0; h < hexes; h++) {
      if (!visible[h] || !this.drawable[h]) continue;
      count++;
      for (let f = 6 * h; f < 6 * h + 6; f++) {
        const other = glued[f] < 0 ? -1 : Math.floor(glued[f] / 6);
        if (!open && other >= 0 && visible[other] && this.drawable[other]) continue;
        for (let k = 0; k < 12; k++) out[at++] = 5 * f + FAN[k];
      }
    }
    this.index.needsUpdate = true;
    this.solid.geometry.setDrawRange(0, at);
    return count;
  }

  /** Colours every hex; `null` leaves the plain colours. */
  colour(of: (hex: number) => Rgb | null): void {
    for (let h = 0; h < this.t.hexes; h++) {
      const c = of(h);
      this.paint.set(c === null ? [0, 0, 0, 0] : [c[0], c[1], c[2], 255], 4 * h);
    }
    this.paintTexture.needsUpdate = true;
  }
}

/** The dual surfaces of sheets: in each visible hex the quad through the middles of four parallel edges. */
export function sheetSurface(t: Topology, points: Float32Array, visible: Uint8Array, chosen: { sheet: number; colour: Rgb }[]): Mesh {
  const quads = chosen.flatMap(({ sheet, colour }) =>
    t.sheets[sheet].quads.filter((k) => visible[Math.floor(k / 3)]).map((k) => ({ k, colour })),
  );
  const n = quads.length;
  const position = new Float32Array(15 * n);
  const bent = new Int8Array(20 * n);
  const tint = new Uint8Array(15 * n);
  const middles = new Float32Array(12);
  quads.forEach(({ k, colour }, i) => {
    for (let j = 0; j < 4; j++) {
      const e = t.edges.ofHex[4 * k + j];
      for (let c = 0; c < 3; c++) middles[3 * j + c] = 0.5 * (points[3 * t.edges.ends[2 * e] + c] + points[3 * t.edges.ends[2 * e + 1] + c]);
    }
    fillQuad([0, 3, 6, 9], middles, position, bent, i, false);
    for (let j = 0; j < 5; j++) tint.set(colour, 15 * i + 3 * j);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(position, 3));
  geometry.setAttribute("bent", new BufferAttribute(bent, 4, true));
  geometry.setAttribute("tint", new BufferAttribute(tint, 3, true));
  geometry.setIndex(new BufferAttribute(Uint32Array.from(quads.flatMap((_, i) => FAN.map((k) => 5 * i + k))), 1));
  const material = new ShaderMaterial({
    glslVersion: GLSL3, vertexShader: SHEET_VERTEX, fragmentShader: SHEET_FRAGMENT, side: DoubleSide,
    uniforms: { lineColour: { value: new Vector3(0.1, 0.12, 0.15) }, lineWidth: { value: 0.7 } },
  });
  return still(new Mesh(geometry, material));
}

/** Positions and corner normals of quad number `i`; `from` are offsets into `points`. */
function fillQuad(from: number[], points: Float32Array, position: Float32Array, bent: Int8Array, i: number, boundary: boolean): void {
  const p = from.map((o) => new Vector3(points[o], points[o + 1], points[o + 2]));
  const middle = new Vector3();
  const mean = new Vector3();
  for (let k = 0; k < 4; k++) {
    middle.addScaledVector(p[k], 0.25);
    const normal = p[(k + 1) % 4].clone().sub(p[k]).cross(p[(k + 3) % 4].clone().sub(p[k])).normalize();
    mean.add(normal);
    put(k, p[k], normal);
  }
  put(4, middle, mean.normalize());
  function put(k: number, at: Vector3, normal: Vector3): void {
    at.toArray(position, 15 * i + 3 * k);
    bent.set([127 * normal.x, 127 * normal.y, 127 * normal.z, boundary ? 127 : 0].map(Math.round), 20 * i + 4 * k);
  }
}

function texture(data: Float32Array | Uint8Array, rows: number, type: typeof FloatType | typeof UnsignedByteType): DataTexture {
  const made = new DataTexture(data as Float32Array<ArrayBuffer>, TEXTURE_WIDTH, rows, RGBAFormat, type);
  made.minFilter = made.magFilter = NearestFilter;
  made.needsUpdate = true;
  return made;
}

function vector(c: Rgb): Vector3 {
  return new Vector3(c[0] / 255, c[1] / 255, c[2] / 255);
}

/** Never culled: hexes move in the shader, where three.js does not see it. */
function still(mesh: Mesh): Mesh {
  mesh.frustumCulled = false;
  return mesh;
}
