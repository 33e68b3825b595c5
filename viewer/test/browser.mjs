// Drives a real Chromium: node test/browser.mjs PAGE [SHOTS]
// The page opens from the disk without a network, plays, and its cursor moves; it is legible to axe; frames per second are counted.

import axe from "axe-core";
import { strict as assert } from "node:assert";
import { existsSync, mkdirSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [file, shots] = process.argv.slice(2);
if (!file) throw new Error("node test/browser.mjs PAGE [SHOTS]");
const program = process.env.CHROMIUM ?? "/usr/bin/chromium";
if (!existsSync(program)) {
  console.error(`no browser at ${program}: install Debian's chromium, or name one in CHROMIUM`);
  process.exit(process.env.CI ? 1 : 0);
}
if (shots) mkdirSync(shots, { recursive: true });
const address = pathToFileURL(resolve(file)).href;
const software = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/** Opens the page; whatever goes wrong in it ends the test. */
async function open({ args = software, hash = "", ...context }) {
  const browser = await chromium.launch({ executablePath: program, args });
  const page = await (await browser.newContext({ viewport: { width: 1280, height: 800 }, offline: true, ...context })).newPage();
  const errors = [];
  const asked = [];
  page.on("pageerror", (e) => errors.push(String(e)));
  page.on("console", (m) => (m.type() === "error" || m.type() === "warning") && !/GPU stall/.test(m.text()) && errors.push(m.text()));
  page.on("request", (r) => asked.push(r.url()));
  await page.goto(address + hash);
  await page.waitForSelector("body[data-ready=yes]", { timeout: 60000 });
  return { browser, page, errors, asked };
}

async function shot(page, name, whole = false) {
  if (shots) await page.screenshot({ path: `${shots}/${name}.png`, fullPage: whole });
}

/** Pixels of the picture that differ from its corner, and a number that differs if any pixel does. */
const look = (page) => page.evaluate(() => {
  const canvas = document.querySelector("#space canvas");
  // what was drawn is kept until this task ends
  window.ropewalk.player.seek(window.ropewalk.player.clock.t);
  const copy = new OffscreenCanvas(canvas.width, canvas.height);
  const pen = copy.getContext("2d");
  pen.drawImage(canvas, 0, 0);
  const p = pen.getImageData(0, 0, canvas.width, canvas.height).data;
  let [ink, mark] = [0, 0];
  for (let i = 0; i < p.length; i += 4) {
    ink += Math.abs(p[i] - p[0]) + Math.abs(p[i + 1] - p[1]) + Math.abs(p[i + 2] - p[2]) > 40;
    mark = (Math.imul(mark, 31) + p[i] + (p[i + 1] << 8) + (p[i + 2] << 16)) | 0;
  }
  return { ink, mark };
});

const place = (page) => page.evaluate(() => document.querySelector("#histories .now").style.transform);

/** Frames per second over two seconds of play, as the browser shows them. */
const rate = (page) => page.evaluate(() => new Promise((done) => {
  let frames = 0;
  let drawn = 0;
  let last = NaN;
  const from = performance.now();
  const tick = (now) => {
    frames++;
    const t = window.ropewalk.player.clock.t;
    if (t !== last) drawn++;
    last = t;
    if (now - from < 3000) requestAnimationFrame(tick);
    else done({ fps: (1000 * frames) / (now - from), drawn: (1000 * drawn) / (now - from) });
  };
  requestAnimationFrame(tick);
}));

async function accessible(page, name) {
  await page.evaluate(axe.source);
  const { violations } = await page.evaluate(() => window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21aa", "best-practice"] }));
  const told = violations.map((v) => `${v.id}: ${v.help} (${v.nodes.map((n) => n.target.join(" ")).slice(0, 3).join("; ")})`);
  assert.deepEqual(told, [], `axe, ${name}`);
}

async function plays(page) {
  const before = await place(page);
  await page.click("#play");
  await page.waitForTimeout(800);
  assert.notEqual(await place(page), before, "the cursor of the plots moves");
  assert.equal(await page.textContent("#play"), "Pause");
}

async function desktop(theme) {
  const { browser, page, errors, asked } = await open({ colorScheme: theme });
  assert.equal(await page.evaluate(() => document.body.dataset.renderer), "webgl");
  assert.ok((await look(page)).ink > 5000, "something is drawn");
  await page.evaluate(() => window.ropewalk.player.seek(20));
  await page.waitForTimeout(300);
  await shot(page, `desktop-${theme}`);
  await shot(page, `whole-${theme}`, true);
  await accessible(page, theme);
  await plays(page);
  const speed = await rate(page);
  await page.click("#play");
  if (theme === "light") await works(page);
  assert.deepEqual(errors, []);
  assert.deepEqual(asked.filter((url) => url !== address && !url.startsWith("data:")), [], "nothing is loaded");
  await browser.close();
  return speed;
}

/** What one can do with the page. */
async function works(page) {
  const t = () => page.evaluate(() => window.ropewalk.player.clock.t);
  const orbit = () => page.evaluate(() => JSON.stringify(window.ropewalk.view.stage.orbit));
  const moved = async (what, act) => {
    const before = await orbit();
    await act();
    assert.notEqual(await orbit(), before, what);
  };
  // time: slider, keys, click in a plot, events
  await page.focus("#slider");
  await page.keyboard.press("Home");
  assert.equal(await t(), await page.evaluate(() => window.ropewalk.part.first));
  await page.keyboard.press("ArrowRight");
  const second = await page.evaluate(() => window.ropewalk.run.field.times[1]);
  assert.equal(await t(), second);
  const over = page.locator("#histories .u-over").first();
  const box = await over.boundingBox();
  await over.click({ position: { x: box.width / 2, y: box.height / 2 } });
  const { first, last } = await page.evaluate(() => ({ first: window.ropewalk.part.first, last: window.ropewalk.part.last }));
  assert.ok(Math.abs((await t()) - (first + last) / 2) < 0.02 * (last - first), "a click in a plot goes there");
  if (await page.locator(".events button").count()) {
    await page.locator(".events button").first().click();
    assert.equal(await t(), await page.evaluate(() => window.ropewalk.run.events[0].t));
  }
  // hover shows values
  await page.evaluate(() => scrollTo(0, 0));
  const there = await over.boundingBox();
  await page.mouse.move(there.x + there.width * 0.25, there.y + 30);
  await page.waitForTimeout(150);
  assert.equal(await page.locator("figure.hovered").count(), await page.locator("#histories figure").count());
  // zoom by dragging: all plots, envelope and player share the window
  await page.mouse.down();
  await page.mouse.move(there.x + there.width * 0.6, there.y + 40, { steps: 5 });
  await page.mouse.up();
  await page.waitForTimeout(200);
  const part = await page.evaluate(() => ({ from: window.ropewalk.part.from, to: window.ropewalk.part.to, clock: window.ropewalk.player.clock.to }));
  assert.ok(part.to - part.from < 0.5 * (last - first) && part.clock === part.to, "a drag zooms");
  await page.mouse.move(2, 2);
  await shot(page, "zoomed");
  await page.click("#whole");
  assert.ok(await page.evaluate(() => window.ropewalk.part.whole));
  // camera
  await page.focus("#space");
  for (const key of ["ArrowLeft", "Shift+ArrowUp", "+", "2", "1", "Shift+ArrowLeft", "f"]) await moved(key, () => page.keyboard.press(key));
  const space = await page.locator("#space").boundingBox();
  const [x, y] = [space.x + space.width / 2, space.y + space.height / 3];
  await moved("drag", async () => {
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 60, y + 20, { steps: 4 });
    await page.mouse.up();
  });
  await moved("wheel", async () => {
    await page.mouse.wheel(0, -200);
    await page.waitForTimeout(100);
  });
  // frame, follow, trail, colour, names, thickness
  for (const id of ["frame", "follow", "trail", "colour", "envelope-of"]) {
    const count = await page.locator(`#${id} option`).count();
    for (let k = 0; k < count; k++) await page.selectOption(`#${id}`, String(k));
  }
  await page.selectOption("#frame", "1");
  await page.check("#names");
  await page.selectOption("#colour", "1");
  await page.locator("#thick").fill("1");
  await page.waitForTimeout(200);
  await shot(page, "frame-of-first");
  await page.selectOption("#frame", "0");
  await forces(page);
  await spectra(page);
  await steps(page);
  await sea(page);
  await tables(page);
  // records
  await page.click("#panels-count");
  const shown = await page.locator("#histories figure").count();
  await page.locator("#panels input").first().click();
  assert.equal(await page.locator("#histories figure").count(), shown - 1);
  await page.locator("#panels input").first().click();
  assert.equal(await page.locator("#histories figure").count(), shown);
  await page.click("#panels-count");
  // the other colours, and paper
  await page.click("#theme");
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
  await page.click("#theme");
  if (shots) await page.pdf({ path: `${shots}/print.pdf`, format: "A4" });
}

/** The surface of waves moves, and says which of them it leaves out. */
async function sea(page) {
  if (!(await page.evaluate(() => window.ropewalk.run.field.waves !== null))) return;
  const at = (t) => page.evaluate((t) => {
    window.ropewalk.player.seek(t);
    const { heights, left } = window.ropewalk.view.stage.sea;
    return { range: Math.max(...heights) - Math.min(...heights), first: heights[0], left: left.count };
  }, t);
  const last = await page.evaluate(() => window.ropewalk.part.last);
  const [one, other] = [await at(last), await at(0.95 * last)];
  assert.ok(one.range > 0 && one.first !== other.first, "the water moves");
  assert.equal(await page.locator("#short-waves").isVisible(), one.left > 0);
}

/** Tables and range graphs of the run are there. */
async function tables(page) {
  const { listings, ranges } = await page.evaluate(() => window.ropewalk.run);
  assert.equal(await page.locator("#listings table").count(), listings.length);
  if (listings.length > 0) assert.equal(await page.locator("#listings table").first().locator("tbody tr").count(), listings[0].rows.length);
  if (ranges.length === 0) return;
  await page.selectOption("#envelope-of", "0");
  assert.match(await page.textContent("#envelope-told"), /over all steps from/);
}

/** Arrows are drawn, and as long as is wished; kinds can be left out. */
async function forces(page) {
  if (!(await page.locator("#choose-forces").isVisible())) return;
  await page.click("#choose-forces summary");
  const boxes = page.locator("#force-kinds input");
  const all = await boxes.count();
  for (let k = 0; k < all; k++) await boxes.nth(k).setChecked(false);
  assert.ok(await page.locator("#forces-legend").isHidden(), "without forces there is no legend");
  const { mark: without } = await look(page);
  for (let k = 0; k < all; k++) await boxes.nth(k).setChecked(true);
  await page.waitForTimeout(150);
  const { mark: arrows } = await look(page);
  assert.ok(arrows !== without, "arrows are drawn");
  assert.match(await page.textContent("#forces-bar span"), /^[125][\d.]*( \S+)? ?[kM]?N$/);
  await page.locator("#force-length").fill("1");
  await page.waitForTimeout(150);
  assert.equal(await page.textContent("#force-length-value"), "10×");
  assert.notEqual((await look(page)).mark, arrows, "longer arrows are drawn longer");
  await page.locator("#force-length").fill("0");
  await page.click("#choose-forces summary");
}

/** Each record has a spectrum, whose integral is what the page says of the variance; also of a window, and on even axes. */
async function spectra(page) {
  if (!(await page.locator("#spectra").isVisible())) return;
  await page.locator("#spectra").scrollIntoViewIfNeeded();
  await page.waitForSelector("#spectrum canvas");
  const count = await page.locator("#spectrum-of option").count();
  for (let k = 0; k < count; k++) {
    await page.selectOption("#spectrum-of", String(k));
    assert.match(await page.textContent("#spectrum-told"), /standard deviation|Too few/);
  }
  await page.selectOption("#spectrum-of", "0");
  const whole = await page.textContent("#spectrum-told");
  await page.evaluate(() => window.ropewalk.part.set(window.ropewalk.part.first, 0.5 * (window.ropewalk.part.first + window.ropewalk.part.last)));
  assert.notEqual(await page.textContent("#spectrum-told"), whole, "the window counts");
  await page.click("#whole");
  await page.selectOption("#spectrum-pieces", "0");
  await page.uncheck("#spectrum-log");
  await page.waitForSelector("#spectrum canvas");
  await page.check("#spectrum-log");
  await page.selectOption("#spectrum-pieces", "2");
}

/** The steps of the solver share the cursor. */
async function steps(page) {
  if (!(await page.locator("#solver").isVisible())) return;
  const where = () => page.evaluate(() => document.querySelector("#steps .now").style.transform);
  const before = await where();
  await page.evaluate(() => window.ropewalk.player.seek(0.3 * window.ropewalk.part.last + 0.7 * window.ropewalk.part.first));
  assert.notEqual(await where(), before);
  assert.match(await page.textContent("#steps-keys"), /%/);
}

async function phone() {
  const { browser, page, errors } = await open({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `the page is ${wide} pixels wider than the phone`);
  await page.evaluate(() => window.ropewalk.player.seek(20));
  await page.waitForTimeout(300);
  await shot(page, "phone");
  await shot(page, "phone-whole", true);
  await plays(page);
  await accessible(page, "phone");
  assert.deepEqual(errors, []);
  await browser.close();
}

async function flat() {
  const { browser, page, errors } = await open({ args: ["--no-sandbox", "--disable-3d-apis"] });
  assert.equal(await page.evaluate(() => document.body.dataset.renderer), "flat");
  await page.evaluate(() => window.ropewalk.player.seek(20));
  await page.waitForTimeout(300);
  const { ink: drawn } = await look(page);
  assert.ok(drawn > 500, `something is drawn without WebGL: ${drawn} pixels`);
  await shot(page, "flat");
  await plays(page);
  const speed = await rate(page);
  // three tells on the console that there is no WebGL
  assert.deepEqual(errors.filter((e) => !/webgl/i.test(e)), []);
  await browser.close();
  return speed;
}

const told = { light: await desktop("light"), dark: await desktop("dark"), flat: await flat() };
await phone();
for (const [name, { fps, drawn }] of Object.entries(told)) console.log(`${name}: ${fps.toFixed(0)} frames per second, ${drawn.toFixed(0)} of them moved`);
// judged apart from the rest: on a loaded machine a number says little
const least = Number(process.env.LEAST_FPS ?? 0);
for (const [name, { drawn }] of Object.entries(told)) assert.ok(drawn >= least, `${name}: ${drawn.toFixed(1)} frames per second, at least ${least} are wanted`);
