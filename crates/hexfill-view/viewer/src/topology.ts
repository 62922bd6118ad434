// Incidence of a hex mesh: glued facets, layers from the boundary, edges and their valence, sheets, columns, chords.
// Everything is numbered by first sight in the order of the hexes, so numbers are stable for a mesh.

/** The six facets counter-clockwise from outside; facet `f ^ 1` is opposite. As in `hexfill_mesh::cube`. */
export const FACETS = [
  [0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7],
];
/** The twelve edges, four in each direction, each four in cyclic order round the hex. */
export const EDGES = [
  [0, 1], [3, 2], [7, 6], [4, 5],
  [0, 3], [1, 2], [5, 6], [4, 7],
  [0, 4], [1, 5], [2, 6], [3, 7],
];

export interface Topology {
  hexes: number;
  corners: Uint32Array;
  /** Per facet (6 * hex + side): the facet glued to it, or -1. */
  glued: Int32Array;
  boundaryFacets: number[];
  /** Per hex: facet steps to the nearest hex with a boundary facet. */
  layer: Int32Array;
  layers: number;
  edges: EdgeTable;
  sheets: Sheet[];
  /** Per hex and direction (3 * hex + direction): the sheet. */
  sheetOf: Int32Array;
  /** Per hex and direction: the column of hexes through opposite facets. */
  columnOf: Int32Array;
  chords: Chord[];
  /** Per boundary facet (order of `boundaryFacets`), two: the chord through sides 0 and 2, and through 1 and 3. */
  chordOf: Int32Array;
}

export interface EdgeTable {
  count: number;
  /** Two vertices an edge. */
  ends: Uint32Array;
  /** Number of hexes round the edge. */
  valence: Uint16Array;
  onBoundary: Uint8Array;
  /** Per hex, twelve (order of `EDGES`): the edge. */
  ofHex: Uint32Array;
}

export interface Sheet {
  /** Hex and direction, as 3 * hex + direction; one quad of the sheet each. */
  quads: number[];
  /** Hexes where the sheet crosses itself. */
  selfCrossings: number;
}

export interface Chord {
  /** Number of distinct boundary quads it runs through. */
  length: number;
  /** The same with a quad counted twice where the chord crosses itself. */
  passages: number;
  selfCrossings: number;
  sheet: number;
}

export function analyse(vertices: number, corners: Uint32Array): Topology {
  const hexes = corners.length / 8;
  const glued = glue(vertices, corners);
  const boundaryFacets: number[] = [];
  for (let f = 0; f < glued.length; f++) if (glued[f] < 0) boundaryFacets.push(f);
  const edges = findEdges(vertices, corners, boundaryFacets);

  const parallel = new Classes(edges.count);
  for (let h = 0; h < hexes; h++) {
    for (let d = 0; d < 3; d++) {
      for (let i = 1; i < 4; i++) parallel.join(edges.ofHex[12 * h + 4 * d], edges.ofHex[12 * h + 4 * d + i]);
    }
  }
  const sheets: Sheet[] = [];
  const sheetNumber = new Map<number, number>();
  const sheetOf = new Int32Array(3 * hexes);
  for (let k = 0; k < 3 * hexes; k++) {
    const root = parallel.root(edges.ofHex[4 * k]);
    const s = number(sheetNumber, root, () => sheets.push({ quads: [], selfCrossings: 0 }));
    sheets[s].quads.push(k);
    sheetOf[k] = s;
  }
  for (let h = 0; h < hexes; h++) {
    const [a, b, c] = [sheetOf[3 * h], sheetOf[3 * h + 1], sheetOf[3 * h + 2]];
    for (const s of new Set([a, b, c])) {
      if (Number(a === s) + Number(b === s) + Number(c === s) > 1) sheets[s].selfCrossings++;
    }
  }

  const stacked = new Classes(3 * hexes);
  for (let f = 0; f < glued.length; f++) if (glued[f] >= 0) stacked.join(f >> 1, glued[f] >> 1);
  const columnNumber = new Map<number, number>();
  const columnOf = Int32Array.from({ length: 3 * hexes }, (_, k) => number(columnNumber, stacked.root(k), () => 0));

  const { chords, chordOf } = findChords(boundaryFacets, edges, (edge) => sheetNumber.get(parallel.root(edge))!);
  const { layer, layers } = peel(hexes, glued);
  return { hexes, corners, glued, boundaryFacets, layer, layers, edges, sheets, sheetOf, columnOf, chords, chordOf };
}

function number(seen: Map<number, number>, key: number, add: () => void): number {
  let n = seen.get(key);
  if (n === undefined) {
    n = seen.size;
    seen.set(key, n);
    add();
  }
  return n;
}

/** Disjoint classes (union-find); the smallest member is the root. */
class Classes {
  private parent: Uint32Array;
  constructor(n: number) {
    this.parent = Uint32Array.from({ length: n }, (_, i) => i);
  }
  root(i: number): number {
    const p = this.parent;
    while (p[i] !== i) i = p[i] = p[p[i]];
    return i;
  }
  join(a: number, b: number): void {
    a = this.root(a);
    b = this.root(b);
    if (a < b) this.parent[b] = a;
    else this.parent[a] = b;
  }
}

/** Facets with the same four vertices, found in lists by smallest vertex. */
function glue(vertices: number, corners: Uint32Array): Int32Array {
  const n = (corners.length / 8) * 6;
  const glued = new Int32Array(n).fill(-1);
  const head = new Int32Array(vertices).fill(-1);
  const next = new Int32Array(n);
  const key = new Uint32Array(4 * n);
  for (let f = 0; f < n; f++) {
    const hex = 8 * Math.floor(f / 6);
    const q = FACETS[f % 6].map((i) => corners[hex + i]).sort((a, b) => a - b);
    key.set(q, 4 * f);
    let g = head[q[0]];
    while (g >= 0 && !(key[4 * g + 1] === q[1] && key[4 * g + 2] === q[2] && key[4 * g + 3] === q[3])) g = next[g];
    if (g >= 0) {
      glued[f] = g;
      glued[g] = f;
    } else {
      next[f] = head[q[0]];
      head[q[0]] = f;
    }
  }
  return glued;
}

function findEdges(vertices: number, corners: Uint32Array, boundaryFacets: number[]): EdgeTable {
  const hexes = corners.length / 8;
  const head = new Int32Array(vertices).fill(-1);
  const next: number[] = [];
  const ends: number[] = [];
  const valence: number[] = [];
  const ofHex = new Uint32Array(12 * hexes);
  const find = (a: number, b: number): number => {
    const low = Math.min(a, b);
    const high = Math.max(a, b);
    for (let e = head[low]; e >= 0; e = next[e]) if (ends[2 * e + 1] === high) return e;
    const e = next.length;
    ends.push(low, high);
    valence.push(0);
    next.push(head[low]);
    head[low] = e;
    return e;
  };
  for (let h = 0; h < hexes; h++) {
    for (let i = 0; i < 12; i++) {
      const e = find(corners[8 * h + EDGES[i][0]], corners[8 * h + EDGES[i][1]]);
      ofHex[12 * h + i] = e;
      valence[e]++;
    }
  }
  const onBoundary = new Uint8Array(next.length);
  for (const f of boundaryFacets) {
    const q = facetVertices(corners, f);
    for (let i = 0; i < 4; i++) onBoundary[find(q[i], q[(i + 1) % 4])] = 1;
  }
  return { count: next.length, ends: Uint32Array.from(ends), valence: Uint16Array.from(valence), onBoundary, ofHex };
}

export function facetVertices(corners: Uint32Array, facet: number): number[] {
  const hex = 8 * Math.floor(facet / 6);
  return FACETS[facet % 6].map((i) => corners[hex + i]);
}

/** The edges of the sides 0-1, 1-2, 2-3, 3-0 of a facet. */
export function facetEdges(edges: EdgeTable, facet: number): number[] {
  const h = Math.floor(facet / 6);
  const q = FACETS[facet % 6];
  return q.map((a, i) => {
    const b = q[(i + 1) % 4];
    const k = EDGES.findIndex(([c, d]) => (c === a && d === b) || (c === b && d === a));
    return edges.ofHex[12 * h + k];
  });
}

/** Chords of the boundary: classes of its edges under opposite in a quad. */
function findChords(boundaryFacets: number[], edges: EdgeTable, sheetOfEdge: (edge: number) => number) {
  const opposite = new Classes(edges.count);
  const sides = boundaryFacets.map((f) => facetEdges(edges, f));
  for (const s of sides) {
    opposite.join(s[0], s[2]);
    opposite.join(s[1], s[3]);
  }
  const chords: Chord[] = [];
  const seen = new Map<number, number>();
  const chordOf = new Int32Array(2 * sides.length);
  sides.forEach((s, i) => {
    for (let k = 0; k < 2; k++) {
      const c = number(seen, opposite.root(s[k]), () => chords.push({ length: 0, passages: 0, selfCrossings: 0, sheet: sheetOfEdge(s[k]) }));
      chords[c].passages++;
      chordOf[2 * i + k] = c;
    }
    if (chordOf[2 * i] === chordOf[2 * i + 1]) chords[chordOf[2 * i]].selfCrossings++;
  });
  for (const c of chords) c.length = c.passages - c.selfCrossings;
  return { chords, chordOf };
}

function peel(hexes: number, glued: Int32Array): { layer: Int32Array; layers: number } {
  const layer = new Int32Array(hexes).fill(-1);
  let front: number[] = [];
  for (let h = 0; h < hexes; h++) {
    for (let side = 0; side < 6; side++) if (glued[6 * h + side] < 0) layer[h] = 0;
    if (layer[h] === 0) front.push(h);
  }
  let depth = 0;
  while (front.length > 0) {
    const following: number[] = [];
    for (const h of front) {
      for (let side = 0; side < 6; side++) {
        const g = glued[6 * h + side];
        const other = Math.floor(g / 6);
        if (g >= 0 && layer[other] < 0) {
          layer[other] = depth + 1;
          following.push(other);
        }
      }
    }
    if (following.length > 0) depth++;
    front = following;
  }
  return { layer, layers: depth + 1 };
}
