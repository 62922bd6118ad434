// Reads the data element of the page, as `src/page.rs` wrote it.

export type Rgb = [number, number, number];

export interface Values {
  name: string;
  data: Float64Array;
  low: number;
  high: number;
  /** Extremes of what occurs; those of an empty list if nothing does. */
  least: number;
  greatest: number;
  flagsNonpositive: boolean;
  ramp: Rgb[];
}

/** Groups of quads, such as boundary conditions. */
export interface Groups {
  names: string[];
  colours: Rgb[];
  /** Facets that are in a group, rising, and the group of each. */
  facets: Uint32Array;
  of: Uint32Array;
  /** The page opens with them. */
  first: boolean;
}

export interface MeshData {
  title: string;
  vertices: number;
  hexes: number;
  /** 3 a vertex; NaN where there is no position. */
  points: Float64Array;
  /** 8 a hex, VTK order. */
  corners: Uint32Array;
  values: Values | null;
  shelling: Uint32Array | null;
  groups: Groups | null;
  facts: [string, string][];
  problems: string[];
  colours: { surface: Rgb; inside: Rgb; unknown: Rgb; flagged: Rgb; quality: Rgb[]; growth: Rgb[] };
}

export function readData(): MeshData {
  const raw = JSON.parse(document.getElementById("data")!.textContent!);
  if (raw.format !== "hexfill-view 1") throw new Error(`unknown data format ${raw.format}`);
  const corners = bytes(raw.corners);
  const wide =
    raw.corner_bytes === 1 ? corners : raw.corner_bytes === 2 ? new Uint16Array(corners.buffer) : new Uint32Array(corners.buffer);
  const values = raw.values && new Float64Array(bytes(raw.values.data).buffer);
  const finite = values && values.filter(Number.isFinite);
  return {
    title: raw.title,
    vertices: raw.vertices,
    hexes: raw.hexes,
    points: new Float64Array(bytes(raw.points).buffer),
    corners: Uint32Array.from(wide),
    values: raw.values && {
      name: raw.values.name,
      data: values,
      low: raw.values.low,
      high: raw.values.high,
      least: finite.reduce((a: number, b: number) => Math.min(a, b), Infinity),
      greatest: finite.reduce((a: number, b: number) => Math.max(a, b), -Infinity),
      flagsNonpositive: raw.values.flags_nonpositive,
      ramp: raw.values.ramp,
    },
    shelling: raw.shelling === null ? null : new Uint32Array(bytes(raw.shelling).buffer),
    groups: raw.groups && {
      names: raw.groups.names,
      colours: raw.groups.colours,
      facets: new Uint32Array(bytes(raw.groups.facets).buffer),
      of: new Uint32Array(bytes(raw.groups.of).buffer),
      first: raw.groups.first,
    },
    facts: raw.facts,
    problems: raw.problems,
    colours: raw.colours,
  };
}

/** Typed arrays read the byte order of the machine, which is little-endian wherever browsers run. */
function bytes(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const out = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) out[i] = text.charCodeAt(i);
  return out;
}
