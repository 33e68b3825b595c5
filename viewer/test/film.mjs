// Makes three pictures of a page's motion and looks whether something moves: node test/film.mjs PAGE.html

import { strict as assert } from "node:assert";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const here = new URL("..", import.meta.url).pathname;
const folder = mkdtempSync(join(tmpdir(), "film-"));
const film = (...words) => spawnSync(process.execPath, [join(here, "film.mjs"), process.argv[2], ...words], { encoding: "utf8" });
const out = join(folder, "pictures");
const made = film(out, "--from", "1", "--to", "3", "--speed", "10", "--fps", "10", "--size", "320x180");
assert.equal(made.status, 0, made.stderr);
const names = readdirSync(out);
assert.deepEqual(names, ["00000.png", "00001.png", "00002.png"]);
const pictures = names.map((name) => readFileSync(join(out, name)));
for (const png of pictures) assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [320, 180]);
assert.ok(!pictures[0].equals(pictures[1]) && !pictures[1].equals(pictures[2]), "something moves");
const refused = film(out);
assert.ok(refused.status === 2 && refused.stderr.includes("isn't empty"), refused.stderr);
if (spawnSync(process.env.FFMPEG ?? "ffmpeg", ["-version"]).status === 0) {
  for (const name of ["a.mp4", "a.gif"]) {
    const said = film(join(folder, name), "--from", "1", "--to", "2", "--speed", "10", "--fps", "10", "--size", "321x181");
    assert.equal(said.status, 0, said.stderr);
    assert.ok(readFileSync(join(folder, name)).length > 500, name);
  }
} else console.log("no ffmpeg: pictures alone");
rmSync(folder, { recursive: true });
console.log("film: well");
