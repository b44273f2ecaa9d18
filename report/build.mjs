// Bundles the pages and writes them as a C++ source: node build.mjs OUTPUT.cpp
// Each page is one HTML file with its style and script in it. The program puts the data between
// its two halves. src/page.html is what all pages share; src/NAME.html is the body of each, with
// the parts src/theme.html and src/view.html.

import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { build, transform } from "esbuild";

const names = ["index", "scan", "scene"];

async function bundle(entry) {
  const result = await build({
    entryPoints: [entry], bundle: true, minify: true, write: false, format: "iife", target: "es2021",
    charset: "utf8", legalComments: "inline",
  });
  return result.outputFiles[0].text;
}

const hash = text => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

/// Returns the page before and behind its data. Its policy admits no other script and no request.
async function halves(name) {
  const script = await bundle(`src/${name}.ts`);
  const style = (await transform(readFileSync("src/report.css", "utf8"), { loader: "css", minify: true })).code;
  const policy = `default-src 'none'; script-src ${hash(script)}; style-src ${hash(style)}; img-src data: blob:; ` +
    "base-uri 'none'; form-action 'none'";
  const part = file => readFileSync(`src/${file}.html`, "utf8").trimEnd();
  const page = `${part("page")}\n`
    .replace("@BODY@", () => part(name))
    .replace("@THEME@", () => part("theme"))
    .replace("@VIEW@", () => part("view"))
    .replace("@WHAT@", () => (name === "scene" ? "The scene and its models" : "The surface"))
    .replace("@POLICY@", () => policy)
    .replace("@STYLE@", () => style)
    .replace("@SCRIPT@", () => script);
  const parts = page.split("@DATA@");
  if (parts.length !== 2) throw new Error(`${name}.html: needs @DATA@ once`);
  return parts;
}

/// Returns the text as a C++ expression, in lines of moderate length. Its size is in it, because
/// compilers count few characters of a constant.
function literal(text) {
  const bytes = Buffer.from(text, "utf8");
  const lines = [];
  for (let begin = 0; begin < bytes.length; begin += 4000) {
    let line = "";
    for (const byte of bytes.subarray(begin, begin + 4000)) {
      const plain = byte >= 0x20 && byte < 0x7f && byte !== 0x22 && byte !== 0x5c && byte !== 0x3f;
      line += plain ? String.fromCharCode(byte) : `\\${byte.toString(8).padStart(3, "0")}`;
    }
    lines.push(`"${line}"`);
  }
  return `std::string_view(\n${lines.join("\n")},\n${bytes.length})`;
}

let source = '#include "jobs/report/pages.hpp"\n\nnamespace semigeo::jobs {\n\nconst Pages& pages() {\n' +
  "  static constexpr Pages kPages = {\n      .missing = {},\n";
for (const name of names) {
  const [before, behind] = await halves(name);
  source += `      .${name} = {${literal(before)}, ${literal(behind)}},\n`;
}
source += "  };\n  return kPages;\n}\n\n}  // namespace semigeo::jobs\n";
writeFileSync(process.argv[2], source);
