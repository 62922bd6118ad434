// Tests of the viewer's topology, state and data code in Node: node test.mjs
import { build } from "esbuild";
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const work = mkdtempSync(join(tmpdir(), "hexfill-view-test-"));
const load = async (name) => {
  const outfile = join(work, `${name}.mjs`);
  await build({ absWorkingDir: here, entryPoints: [`src/${name}.ts`], outfile, bundle: true, format: "esm", logLevel: "warning" });
  return import(pathToFileURL(outfile).href);
};
const { analyse } = await load("topology");
const { initialState, toHash, fromHash } = await load("state");
const { sample, valueColour, onScale } = await load("colour");
rmSync(work, { recursive: true });

/** nx by ny by nz cubes; `wrap` closes the x direction to a ring. */
function grid(nx, ny, nz, wrap = false) {
  const w = wrap ? nx : nx + 1;
  const id = (x, y, z) => (x % w) + w * (y + (ny + 1) * z);
  const corners = [];
  for (let z = 0; z < nz; z++)
    for (let y = 0; y < ny; y++)
      for (let x = 0; x < nx; x++)
        for (const [a, b, c] of [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]) corners.push(id(x + a, y + b, z + c));
  return analyse(w * (ny + 1) * (nz + 1), Uint32Array.from(corners));
}
const lengths = (list, f) => list.map(f).sort((a, b) => a - b);

let t = grid(1, 1, 1);
assert.equal(t.edges.count, 12);
assert.equal(t.boundaryFacets.length, 6);
assert.deepEqual([t.sheets.length, t.chords.length, t.layers], [3, 3, 1]);
assert.deepEqual(lengths(t.chords, (c) => c.length), [4, 4, 4]);

t = grid(3, 4, 5);
// Edges of a grid, its inner ones (all with four hexes), sheets, and columns nx ny + ny nz + nz nx.
assert.equal(t.edges.count, 3 * 5 * 6 + 4 * 4 * 6 + 4 * 5 * 5);
let inner = Array.from({ length: t.edges.count }, (_, e) => e).filter((e) => !t.edges.onBoundary[e]);
assert.equal(inner.length, 3 * 3 * 4 + 2 * 4 * 4 + 2 * 3 * 5);
assert.ok(inner.every((e) => t.edges.valence[e] === 4));
assert.deepEqual(lengths(t.sheets, (s) => s.quads.length), [12, 12, 12, 12, 12, 15, 15, 15, 15, 20, 20, 20]);
assert.equal(Math.max(...t.columnOf) + 1, 3 * 4 + 4 * 5 + 5 * 3);
assert.equal(t.chords.length, 12);
assert.ok(t.chords.every((c, i) => t.sheets[c.sheet].selfCrossings === 0 && c.selfCrossings === 0 && i >= 0));
// The chord of a sheet of 15 quads in a 3 x 5 rectangle runs through 2 (3 + 5) quads.
for (const c of t.chords) assert.ok([14, 16, 18].includes(c.length) && t.sheets[c.sheet].quads.length === { 14: 12, 16: 15, 18: 20 }[c.length]);
assert.deepEqual(lengths([0, 1], (l) => t.layer.filter((x) => x === l).length), [6, 54]);
for (let f = 0; f < t.glued.length; f++) if (t.glued[f] >= 0) assert.equal(t.glued[t.glued[f]], f);

// A ring: the column round it is closed, and so is its boundary.
t = grid(5, 1, 1, true);
assert.deepEqual([t.edges.count, t.boundaryFacets.length, t.sheets.length], [40, 20, 7]);
assert.deepEqual(lengths(t.sheets, (s) => s.quads.length), [1, 1, 1, 1, 1, 5, 5]);
assert.equal(t.chords.length, 5 + 2 + 2);
assert.equal(Math.max(...t.columnOf) + 1, 1 + 5 + 5);

// Links: all that is set comes back; nonsense does not get in.
const start = initialState();
const limits = { hexes: 60, layers: 2, sheets: 12, chords: 12, columns: 47, values: true };
const state = {
  ...start, shrink: 0.8, explode: 0.25, colour: "value", scale: "range", limit: 0.125, normal: [0.6, 0, 0.8], cut: 0.4, flip: true, peel: 1, boundary: "xray",
  singular: "all", sheet: 3, sheetAs: "place", chord: "all", column: 46, shown: 60, picked: 59, hidden: [1, 5], theme: "dark",
};
const camera = [1, 2, 3, 0, 0.5, 0, 0, 0, 1];
assert.deepEqual(fromHash(toHash(state, start, camera), start, limits), { state, camera });
assert.equal(toHash(start, start, camera), "#cam=1,2,3,0,0.5,0,0,0,1");
for (const hash of ["", "#", "#cut=2&shrink=0&sheet=12&chord=-1&picked=60&shown=61&peel=2&column=47&hidden=60,x&boundary=x&cam=1,2,3&normal=0,0,0&colour=%00", "#a=b&&=&%20=", "#%", "#cut=%zz&%=1"])
  assert.deepEqual(fromHash(hash, start, limits), { state: start, camera: null }, hash);
assert.equal(fromHash("#colour=value&limit=1", start, { ...limits, values: false }).state.colour, "plain");

assert.deepEqual(sample([[0, 0, 0], [100, 200, 50]], 0.5), [50, 100, 25]);
const values = { low: 0, high: 1, flagsNonpositive: true, ramp: [[0, 0, 0], [200, 200, 200]] };
assert.deepEqual([NaN, 0, 0.5, 9].map((x) => valueColour(values, x, [1, 1, 1], [2, 2, 2])[0]), [1, 2, 100, 200]);
assert.equal(valueColour(onScale({ ...values, least: 0.4, greatest: 0.6 }, "range"), 0.6, [1, 1, 1], [2, 2, 2])[0], 200);

// Five cubes (the mesh of `enumerate 5` with the fewest chords): lengths count a quad once, passages twice where a chord crosses itself.
t = analyse(16, Uint32Array.from([
  0, 1, 2, 3, 4, 5, 6, 7, 8, 0, 3, 9, 10, 4, 7, 11, 1, 12, 13, 2, 5, 14, 15, 6, 2, 8, 9, 13, 1, 10, 11, 12, 9, 3, 15, 13, 11, 7, 14, 12,
]));
assert.deepEqual(t.chords.map((c) => [c.length, c.passages, c.selfCrossings]), [[4, 4, 0], [16, 22, 6], [6, 6, 0]]);

if (process.argv[2]) {
  const k = Number(process.argv[2]);
  const before = performance.now();
  grid(k, k, k);
  console.log(`${k ** 3} hexes analysed in ${Math.round(performance.now() - before)} ms (with making the grid)`);
}
console.log("viewer: all tests passed");
