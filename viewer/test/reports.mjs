// Opens the pages of real runs: node test/reports.mjs [--shots DIR] FOLDER...
// Each page must open from the disk without a fault and without asking for anything, show its title, its panels and
// something that moves, be legible to axe, fit a phone, and be smaller than 2 MB. Those in LEAST play at least so fast,
// drawn by the processor at 1280 × 800: the best of three tries counts, since other work on the machine is no fault.

import axe from "axe-core";
import { strict as assert } from "node:assert";
import { existsSync, mkdirSync, statSync } from "node:fs";
import { basename, dirname, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const words = process.argv.slice(2);
const at = words.indexOf("--shots");
const shots = at < 0 ? null : words.splice(at, 2)[1];
if (words.length === 0) throw new Error("node test/reports.mjs [--shots DIR] FOLDER...");
const program = process.env.CHROMIUM ?? "/usr/bin/chromium";
if (!existsSync(program)) {
  console.error(`no browser at ${program}: install Debian's chromium, or name one in CHROMIUM`);
  process.exit(process.env.CI ? 1 : 0);
}
if (shots) mkdirSync(shots, { recursive: true });
const sights = {
  light: { viewport: { width: 1280, height: 800 } },
  dark: { viewport: { width: 1280, height: 800 }, colorScheme: "dark" },
  phone: { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true },
};

/** Frames per second, by the name of the folder; SLOW=1 says that the machine has other work, and asks for none. */
const LEAST = process.env.SLOW ? {} : { "hose-turn": 20, drum: 12 };

/** Frames per second that moved, over two seconds of play. */
const rate = (page) => page.evaluate(() => new Promise((done) => {
  const { player } = window.ropewalk;
  if (!player.clock.playing) player.toggle();
  const from = performance.now();
  let [drawn, last] = [0, NaN];
  const tick = (now) => {
    drawn += Number(player.clock.t !== last);
    last = player.clock.t;
    if (now - from < 2000) requestAnimationFrame(tick);
    else done((1000 * drawn) / (now - from));
  };
  requestAnimationFrame(tick);
}));

async function fast(page, name) {
  const least = LEAST[name];
  let best = 0;
  // a machine that does something else for a while says nothing of the page
  for (let k = 0; k < 10 && best < least; k++) best = Math.max(best, await rate(page));
  console.log(`${name}: ${best.toFixed(0)} frames per second`);
  assert.ok(best >= least, `${name}: ${best.toFixed(1)} frames per second, at least ${least} are wanted`);
}

/** Pixels of the picture that differ from its corner. */
const ink = (page) => page.evaluate(() => {
  const canvas = document.querySelector("#space canvas");
  window.ropewalk.player.seek(window.ropewalk.player.clock.t);
  const copy = new OffscreenCanvas(canvas.width, canvas.height);
  const pen = copy.getContext("2d");
  pen.drawImage(canvas, 0, 0);
  const p = pen.getImageData(0, 0, canvas.width, canvas.height).data;
  let n = 0;
  for (let i = 0; i < p.length; i += 4) n += Math.abs(p[i] - p[0]) + Math.abs(p[i + 1] - p[1]) + Math.abs(p[i + 2] - p[2]) > 120;
  return n;
});

async function open(browser, file, name, sight, still) {
  const page = await (await browser.newContext({ offline: true, ...sights[sight] })).newPage();
  const wrong = [];
  const address = pathToFileURL(file).href;
  page.on("pageerror", (e) => wrong.push(String(e)));
  page.on("console", (m) => (m.type() === "error" || m.type() === "warning") && !/GPU stall/.test(m.text()) && wrong.push(m.text()));
  // the list of a sweep shows the pictures beside it; the page of a run holds all that it shows
  const beside = new URL(".", address).href;
  const own = (url) => url === address || url.startsWith("data:") || (still && url.startsWith(beside));
  page.on("request", (r) => own(r.url()) || wrong.push(`asks for ${r.url()}`));
  await page.goto(address);
  if (!still) await moving(page, name, sight);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `${name}, ${sight}: ${wide} pixels too wide`);
  if (shots) await page.screenshot({ path: join(shots, `${name}-${sight}.png`) });
  await page.evaluate(axe.source);
  const { violations } = await page.evaluate(() => window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21aa", "best-practice"] }));
  assert.deepEqual(violations.map((v) => `${v.id}: ${v.help}`), [], `axe, ${name}, ${sight}`);
  if (sight === "light" && name in LEAST) await fast(page, name);
  assert.deepEqual(wrong, [], `${name}, ${sight}`);
  await page.close();
}

/** The page of a run has a title, panels and something that moves. */
async function moving(page, name, sight) {
  await page.waitForSelector("body[data-ready=yes]", { timeout: 60000 });
  const told = await page.evaluate(() => {
    const { run, part, player } = window.ropewalk;
    player.seek(part.first + 0.6 * (part.last - part.first));
    return { title: document.title, panels: run.panels.length, moving: run.field.lines.length + run.field.bodies.length };
  });
  await page.waitForTimeout(300);
  assert.ok(told.title && told.panels > 0, `${name}: a title and panels`);
  if (told.moving > 0) assert.ok((await ink(page)) > 200, `${name}, ${sight}: something is drawn`);
}

const browser = await chromium.launch({ executablePath: program, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
for (const folder of words) {
  const file = resolve(folder.endsWith(".html") ? folder : join(folder, "report.html"));
  const still = folder.endsWith("index.html") || folder.endsWith("verification.html");
  const name = basename(folder.endsWith(".html") && !still ? file.slice(0, -5) : dirname(file));
  const size = statSync(file).size;
  assert.ok(size < 2e6, `${name}: ${size} bytes`);
  for (const sight of Object.keys(sights)) await open(browser, file, name, sight, still);
  console.log(`${name}: ${(size / 1e6).toFixed(2)} MB`);
}
await browser.close();
