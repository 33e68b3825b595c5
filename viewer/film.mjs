// Pictures of the motion, one after the other, and a film of them if there is ffmpeg.
//   node film.mjs PAGE.html OUT [--from S] [--to S] [--speed X] [--fps 25] [--size 1280x720] [--view 3D|top|side|end] [--dark]
// OUT is a film (.mp4, .webm, .gif) or a folder for the pictures. What else the page can show it is told as in a browser, by
// --do 'JavaScript', such as --do 'document.querySelector("#names").click()'.

import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { extname, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { parseArgs } from "node:util";
import { chromium } from "playwright-core";

const text = (fallback) => ({ type: "string", ...(fallback && { default: fallback }) });
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { from: text(), to: text(), speed: text(), fps: text("25"), size: text("1280x720"), view: text(), do: text(), dark: { type: "boolean", default: false } },
});
const fail = (message) => {
  console.error(message);
  process.exit(2);
};
if (positionals.length !== 2) fail("node film.mjs PAGE.html OUT.mp4 (or a folder)");
const [file, out] = positionals.map((path) => resolve(path));
const program = process.env.CHROMIUM ?? "/usr/bin/chromium";
if (!existsSync(file)) fail(`there is no page ${file}: \`ropewalk run\` leaves report.html`);
if (!existsSync(program)) fail(`no browser at ${program}: install Debian's chromium, or name one in CHROMIUM`);
const [width, height] = values.size.split("x").map(Number);
const fps = Number(values.fps);
if (!(width > 0 && height > 0 && fps > 0)) fail("--size is two numbers such as 1280x720, --fps a number");
const film = [".mp4", ".webm", ".gif"].includes(extname(out));
const folder = film ? mkdtempSync(join(tmpdir(), "film-")) : out;
mkdirSync(folder, { recursive: true });
if (readdirSync(folder).length > 0) fail(`${folder} isn't empty`);

const browser = await chromium.launch({ executablePath: program, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
const page = await (await browser.newContext({ viewport: { width, height }, colorScheme: values.dark ? "dark" : "light", bypassCSP: true, offline: true })).newPage();
await page.goto(pathToFileURL(file).href);
await page.waitForSelector("body[data-ready=yes]", { timeout: 60000 });
// the picture alone, over all of the window
await page.addStyleTag({ content: "#space { position: fixed !important; inset: 0; width: 100vw; height: 100vh !important; z-index: 9; border: 0 !important; border-radius: 0 !important } body { overflow: hidden }" });
const names = { "3D": "space", space: "space", top: "top", side: "side", end: "end" };
if (values.view && !(values.view in names)) fail("--view is one of 3D, top, side, end");
const run = await page.evaluate(([view, told]) => {
  const { view: shown, part, player } = window.ropewalk;
  if (!shown) return null;
  shown.resize();
  if (view) document.querySelector(`[data-view=${view}]`).click();
  else shown.fit(shown.stage.followed ? "now" : "all");
  if (told) new Function(told)();
  return { first: part.first, last: part.last, speed: player.clock.speed };
}, [names[values.view] ?? "", values.do ?? ""]);
if (!run) fail("nothing moves on this page");
const [from, to, speed] = [Number(values.from ?? run.first), Number(values.to ?? run.last), Number(values.speed ?? run.speed)];
if (!(to >= from && speed > 0)) fail("--from, --to and --speed are numbers, the end isn't before the start");
const count = Math.floor(((to - from) / speed) * fps) + 1;
for (let k = 0; k < count; k++) {
  await page.evaluate((t) => window.ropewalk.player.seek(t), Math.min(to, from + (k * speed) / fps));
  await page.screenshot({ path: join(folder, `${String(k).padStart(5, "0")}.png`) });
}
await browser.close();
if (film) {
  const even = "scale=trunc(iw/2)*2:trunc(ih/2)*2";
  const how = extname(out) === ".gif" ? ["-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse"] : ["-vf", even, "-pix_fmt", "yuv420p"];
  const words = ["-y", "-loglevel", "error", "-framerate", String(fps), "-i", join(folder, "%05d.png"), ...how, out];
  const made = spawnSync(process.env.FFMPEG ?? "ffmpeg", words, { stdio: "inherit" });
  if (made.error) fail(`there is no ffmpeg; the pictures are in ${folder}: ffmpeg ${words.join(" ")}`);
  if (made.status !== 0) process.exit(made.status ?? 1);
  rmSync(folder, { recursive: true });
}
console.log(`${count} pictures, ${(count / fps).toFixed(1)} s: ${out}`);
