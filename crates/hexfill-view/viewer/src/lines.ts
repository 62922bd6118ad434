// Lines: the wire frame of the boundary, singular edges by valence, chords, the outline of the picked hex.

import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { category, EXCESS } from "./colour";
import type { Rgb } from "./data";
import { facetEdges, facetVertices, type Topology } from "./topology";

export interface Style {
  width: number;
  colour?: number;
  opacity?: number;
  onTop?: boolean;
}

/** Segments as pairs of points, 6 numbers each, with a colour each if `colours` is given. */
export function segments(coordinates: number[], style: Style, colours?: Rgb[]): LineSegments2 {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(coordinates);
  if (colours) geometry.setColors(colours.flatMap((c) => [...c, ...c].map((x) => x / 255)));
  const material = new LineMaterial({
    color: colours ? 0xffffff : (style.colour ?? 0),
    vertexColors: colours !== undefined,
    linewidth: style.width,
    transparent: (style.opacity ?? 1) < 1,
    opacity: style.opacity ?? 1,
    depthTest: !style.onTop,
  });
  const lines = new LineSegments2(geometry, material);
  lines.frustumCulled = false;
  lines.renderOrder = style.onTop ? 5 : 1;
  return lines;
}

export function ends(t: Topology, points: Float32Array, edge: number): number[] {
  const [a, b] = [3 * t.edges.ends[2 * edge], 3 * t.edges.ends[2 * edge + 1]];
  return [points[a], points[a + 1], points[a + 2], points[b], points[b + 1], points[b + 2]];
}

/** Boundary edges; those with a corner that cannot be drawn are left out. */
export function boundaryWire(t: Topology, points: Float32Array): number[] {
  const coordinates: number[] = [];
  for (let e = 0; e < t.edges.count; e++) {
    if (!t.edges.onBoundary[e]) continue;
    const segment = ends(t, points, e);
    if (segment.every(Number.isFinite)) coordinates.push(...segment);
  }
  return coordinates;
}

export function excess(t: Topology, edge: number): number {
  return t.edges.valence[edge] - (t.edges.onBoundary[edge] ? 2 : 4);
}

/** Edges with another number of hexes than a regular one: inside 4, on the boundary 2. */
export function singularEdges(t: Topology, points: Float32Array, boundaryToo: boolean): { coordinates: number[]; colours: Rgb[] } {
  const coordinates: number[] = [];
  const colours: Rgb[] = [];
  for (let e = 0; e < t.edges.count; e++) {
    const x = excess(t, e);
    if (x === 0 || (t.edges.onBoundary[e] && !boundaryToo)) continue;
    const segment = ends(t, points, e);
    if (!segment.every(Number.isFinite)) continue;
    coordinates.push(...segment);
    colours.push(EXCESS.find((k) => k.of(x))!.colour);
  }
  return { coordinates, colours };
}

/** The chords as curves on the boundary: in each quad from side middle to side middle through its centre. */
export function chordCurves(t: Topology, points: Float32Array, chosen: number | "all"): { coordinates: number[]; colours: Rgb[] } {
  const coordinates: number[] = [];
  const colours: Rgb[] = [];
  t.boundaryFacets.forEach((facet, i) => {
    for (let k = 0; k < 2; k++) {
      const chord = t.chordOf[2 * i + k];
      if (chosen !== "all" && chord !== chosen) continue;
      const sides = facetEdges(t.edges, facet);
      const middle = (s: number[]) => [0.5 * (s[0] + s[3]), 0.5 * (s[1] + s[4]), 0.5 * (s[2] + s[5])];
      const a = middle(ends(t, points, sides[k]));
      const b = middle(ends(t, points, sides[k + 2]));
      const q = facetVertices(t.corners, facet);
      const centre = [0, 1, 2].map((c) => q.reduce((sum, v) => sum + points[3 * v + c] / 4, 0));
      if (![...a, ...b, ...centre].every(Number.isFinite)) continue;
      coordinates.push(...a, ...centre, ...centre, ...b);
      colours.push(category(chord), category(chord));
    }
  });
  return { coordinates, colours };
}
