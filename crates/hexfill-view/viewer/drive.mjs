// Opens pages in headless Chromium, over the debugging pipe, in real time: pictures and the exercise.
// Usage: node drive.mjs PAGE.html [--shot OUT.png] [--hash LINK] [--size 1280x800] [--dark] [--no-webgl] [--exercise] [--pair]
// Exit code 1 if the page has an error, asks for anything over a network, or does not start (with --no-webgl: does not
// say why it did not start). Environment: CHROMIUM is the browser to use.
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const args = process.argv.slice(2);
const flag = (name) => args.includes(name);
const option = (name, otherwise) => (flag(name) ? args[args.indexOf(name) + 1] : otherwise);
const page = resolve(args[0]);
const [width, height] = option("--size", "1280x800").split("x").map(Number);

const profile = mkdtempSync(join(tmpdir(), "hexfill-view-"));
const gl = flag("--no-webgl") ? ["--disable-gpu", "--disable-3d-apis"] : ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = spawn(
  process.env.CHROMIUM ?? "chromium",
  ["--headless", "--no-sandbox", "--no-first-run", "--hide-scrollbars", "--disable-background-networking", "--disable-component-update",
    "--remote-debugging-pipe", `--user-data-dir=${profile}`, `--window-size=${width},${height}`, ...gl, "about:blank"],
  { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] },
);
const waiting = new Map();
const events = [];
let pending = Buffer.alloc(0);
browser.stdio[4].on("data", (bytes) => {
  pending = Buffer.concat([pending, bytes]);
  for (let end; (end = pending.indexOf(0)) >= 0; pending = pending.subarray(end + 1)) {
    const message = JSON.parse(pending.subarray(0, end).toString());
    if (message.id !== undefined) waiting.get(message.id)(message);
    else events.push(message);
  }
});
let last = 0;
let session;
function send(method, params = {}) {
  const id = ++last;
  browser.stdio[3].write(JSON.stringify({ id, method, params, ...(session && { sessionId: session }) }) + "\0");
  return new Promise((done, fail) => waiting.set(id, (m) => (m.error ? fail(new Error(`${method}: ${m.error.message}`)) : done(m.result))));
}
async function evaluate(expression) {
  const { result, exceptionDetails } = await send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
  if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
  return result.value;
}
const wait = (ms) => new Promise((done) => setTimeout(done, ms));

async function run() {
  const { targetId } = await send("Target.createTarget", { url: "about:blank" });
  session = (await send("Target.attachToTarget", { targetId, flatten: true })).sessionId;
  await send("Page.enable");
  await send("Runtime.enable");
  await send("Network.enable");
  await send("Log.enable");
  await send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
  await send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: flag("--dark") ? "dark" : "light" }] });
  const hash = option("--hash", "");
  await send("Page.navigate", { url: pathToFileURL(page).href + (hash && `#${hash}`) });
  const one = 'document.readyState === "complete" ? document.body.className + "|" + document.getElementById("why").textContent : ""';
  // Two pages in frames: both must be ready.
  const both = '[...document.querySelectorAll("iframe")].filter((f) => f.contentDocument?.body?.className.includes("ready")).length === 2 ? "ready" : ""';
  const words = flag("--pair") ? both : one;
  let state = "";
  for (let i = 0; i < 600 && !/^ready|could not start/.test(state); i++) {
    await wait(100);
    state = await evaluate(words);
  }
  await wait(400);
  if (flag("--no-webgl")) {
    if (!state.includes("could not start")) throw new Error(`without WebGL the page says: ${state}`);
    const seen = await evaluate('getComputedStyle(document.getElementById("fallback")).display !== "none" && document.querySelector("#fallback img").naturalWidth');
    if (!(seen > 100)) throw new Error("without WebGL the still picture is not shown");
  } else if (!state.startsWith("ready")) {
    throw new Error(`the interactive view did not start: ${state}`);
  }
  if (flag("--pair")) console.log(await evaluate(readFileSync(join(dirname(fileURLToPath(import.meta.url)), "pair.js"), "utf8")));
  if (flag("--exercise")) console.log(await evaluate(readFileSync(join(dirname(fileURLToPath(import.meta.url)), "exercise.js"), "utf8")));
  if (flag("--shot")) {
    const { data } = await send("Page.captureScreenshot", { format: "png" });
    writeFileSync(option("--shot"), Buffer.from(data, "base64"));
    console.log(option("--shot"));
  }
  const troubles = events.flatMap(({ method, params }) => {
    if (method === "Runtime.exceptionThrown") return [params.exceptionDetails.exception?.description ?? params.exceptionDetails.text];
    if (method === "Network.requestWillBeSent" && !/^(file|data|blob|about):/.test(params.request.url)) return [`asks for ${params.request.url}`];
    // The page itself reports a failed start, and Chromium the missing WebGL.
    const expected = flag("--no-webgl") || /GPU stall|GL Driver Message/.test(JSON.stringify(params));
    if (method === "Runtime.consoleAPICalled" && ["error", "warning"].includes(params.type) && !expected) return [JSON.stringify(params.args.map((a) => a.value ?? a.description))];
    if (method === "Log.entryAdded" && params.entry.level === "error" && !expected) return [params.entry.text];
    return [];
  });
  if (troubles.length > 0) throw new Error(troubles.join("\n"));
}

let code = 0;
try {
  await Promise.race([run(), wait(300_000).then(() => Promise.reject(new Error("no answer in five minutes")))]);
} catch (error) {
  console.error(`${args[0]}: ${error.message}`);
  code = 1;
}
const gone = new Promise((done) => browser.on("exit", done));
session = undefined;
send("Browser.close").catch(() => {});
await Promise.race([gone, wait(5000)]);
browser.kill("SIGKILL");
try {
  rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 200 });
} catch {
  // A helper process of the browser still writes; the folder is in the temporary directory.
}
process.exit(code);
