// Makes report/src/page/report.html, the template that the Rust crate puts a run's data into.
// The same bytes on every machine: nothing but the sources and package-lock.json go into it.

import { build, transform } from "esbuild";
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";

const here = new URL(".", import.meta.url);
const read = (path) => readFileSync(new URL(path, here), "utf8").replaceAll("\r\n", "\n");
const target = "es2022";

const bundle = await build({
  absWorkingDir: here.pathname,
  entryPoints: ["src/main.ts"],
  bundle: true,
  minify: true,
  format: "iife",
  target,
  charset: "utf8",
  legalComments: "none",
  write: false,
  metafile: true,
});
// a script must not hold its own end
const script = bundle.outputFiles[0].text.trim().replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const styles = read("node_modules/uplot/dist/uPlot.min.css") + read("src/page.css");
const css = (await transform(styles, { loader: "css", minify: true, charset: "utf8" })).code.trim();

const version = (name) => JSON.parse(read(`node_modules/${name}/package.json`)).version;
const licences = [["three.js", "three"], ["uPlot", "uplot"]]
  .map(([name, folder]) => `${name} ${version(folder)}, https://www.npmjs.com/package/${folder}\n\n${read(`node_modules/${folder}/LICENSE`).trim()}`)
  .join("\n\n\n")
  .replaceAll("&", "&amp;")
  .replaceAll("<", "&lt;");

// only this very script and style run, and nothing is loaded
const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const csp = `default-src 'none'; script-src ${hash(script)}; style-src ${hash(css)}; base-uri 'none'; form-action 'none'`;

let page = read("src/page.html");
for (const [place, text] of [["/*CSP*/", csp], ["/*CSS*/", css], ["/*LICENCES*/", licences], ["/*SCRIPT*/", script]]) {
  if (page.split(place).length !== 2) throw new Error(`one ${place} is needed in src/page.html`);
  page = page.replace(place, () => text);
}
const out = process.argv[2] ?? new URL("../report/src/page/report.html", here);
writeFileSync(out, page);

const parts = {};
for (const [file, { bytesInOutput }] of Object.entries(Object.values(bundle.metafile.outputs)[0].inputs)) {
  const name = file.match(/node_modules\/([^/]+)/)?.[1] ?? "own";
  parts[name] = (parts[name] ?? 0) + bytesInOutput;
}
console.log(`${Buffer.byteLength(page)} bytes`, parts);
