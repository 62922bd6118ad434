// Bundles src/main.ts with three.js into one script; the licence of three.js stays in front of it.
// Usage: node build.mjs [OUT]   (default dist/viewer.js)
import { build } from "esbuild";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const licence = readFileSync(join(here, "node_modules/three/LICENSE"), "utf8").replace(/\r/g, "").trim();
await build({
  absWorkingDir: here,
  entryPoints: ["src/main.ts"],
  outfile: process.argv[2] ?? join(here, "dist/viewer.js"),
  bundle: true,
  minify: true,
  format: "iife",
  target: ["es2022"],
  charset: "ascii",
  legalComments: "inline",
  banner: { js: `/*! hexfill viewer, MIT OR Apache-2.0. Contains three.js (threejs.org) under this licence:\n\n${licence}\n*/` },
  logLevel: "warning",
});
