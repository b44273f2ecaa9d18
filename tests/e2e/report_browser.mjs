// The pages of a report in a real browser: node report_browser.mjs PACKAGES BROWSER CHECK ARGUMENTS...
// PACKAGES is the folder where playwright-core is installed. The program ends with 1 and says why if
// a check fails.

import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [packages, browserPath, check, ...given] = process.argv.slice(2);
const { chromium } = createRequire(join(packages, "package.json"))("playwright-core");

/// The names of the shown rows, from the top.
const names = page => page.$$eval("#rows tr:not([hidden]) th", cells => cells.map(cell => cell.textContent));

const sortBy = (page, title) => page.click(`#columns button:has-text("${title}")`);

const states = page => page.$$eval("#rows tr:not([hidden]) .state", cells => cells.map(cell => cell.textContent));

/// Fails if the page is wider than its window, or if a control has no name for screen readers.
async function isUsable(page) {
  for (const width of [390, 1280, 2560]) {
    await page.setViewportSize({ width, height: 500 });
    const excess = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    assert.equal(excess, 0, `at ${width} pixels the page is ${excess} pixels too wide`);
  }
  await page.setViewportSize({ width: 1280, height: 900 });
  const nameless = await page.$$eval("input, select, button, a[href], canvas[tabindex]", controls => controls
    .filter(one => !one.hidden && !(one.labels?.length || one.getAttribute("aria-label") || one.textContent.trim()))
    .map(one => one.outerHTML));
  assert.deepEqual(nameless, []);
  for (const landmark of ["header", "main", "h1"]) assert.equal(await page.locator(landmark).count(), 1, landmark);
  assert.deepEqual(await page.$$eval("section", all => all
    .filter(one => !one.getAttribute("aria-label") && !one.getAttribute("aria-labelledby")).map(one => one.outerHTML)), []);
  // What has the focus is seen to have it.
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press("Tab");
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle), "solid");
}

/// Keeps the pixels of the view, when what was asked for is drawn, and returns the share of them that
/// differ from those that were kept before, or, the first time, from the first pixel.
const shareOfNewPixels = page => page.evaluate(async () => {
  await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
  const from = document.getElementById("canvas");
  const to = Object.assign(document.createElement("canvas"), { width: 240, height: 160 });
  const context = to.getContext("2d");
  context.drawImage(from, 0, 0, 240, 160);
  const now = context.getImageData(0, 0, 240, 160).data;
  const before = window.keptPixels ?? now.map((_, i) => now[i % 4]);
  window.keptPixels = now;
  let count = 0;
  for (let i = 0; i < now.length; i += 4)
    if ([0, 1, 2].some(c => Math.abs(now[i + c] - before[i + c]) > 10)) ++count;
  return count / (now.length / 4);
});

/// Fails unless something is drawn on the background.
async function isDrawn(page) {
  assert.ok(await shareOfNewPixels(page) > 0.05, "nothing is drawn");
}

/// Does something to the page, and expects other pixels.
async function changes(page, what, action) {
  await shareOfNewPixels(page);
  await action();
  assert.ok(await shareOfNewPixels(page) > 0.0003, `${what} changes nothing`);
}

const checks = {
  /// A small archive: INDEX and, as JSON, the names and failures that it must show.
  async index(page, wanted) {
    const { title, names: all, failed, reason, remedy, scenes } = JSON.parse(wanted);
    assert.equal(await page.getAttribute("html", "lang"), "en");
    assert.equal(await page.textContent("h1"), title);
    assert.deepEqual([...(await names(page))].sort(), [...all].sort());

    // Failures stand first, in the table and above it.
    assert.equal((await names(page))[0], failed);
    assert.match(await page.textContent("#failure-list li .name"), new RegExp(failed.replace(/\W/g, ".")));
    const failure = await page.textContent("#failure-list li");
    assert.ok(failure.includes(reason), failure);
    assert.ok(failure.includes(`What to do: ${remedy}`), failure);

    await sortBy(page, "Vertices");
    const vertices = () => page.$$eval("#rows tr td:nth-child(5)", cells =>
      cells.map(cell => Number(cell.textContent.replace(/,/g, ""))).filter(Number.isFinite));
    const ascending = await vertices();
    assert.ok(ascending.length > 1);
    assert.deepEqual(ascending, [...ascending].sort((a, b) => a - b));
    assert.equal(await page.getAttribute("#columns th:nth-child(5)", "aria-sort"), "ascending");
    await sortBy(page, "Vertices");
    assert.deepEqual(await vertices(), [...ascending].reverse());
    assert.equal(await page.getAttribute("#columns th:nth-child(5)", "aria-sort"), "descending");

    // By keyboard alone: a head sorts, '/' leads to the search.
    await page.focus("#columns th:nth-child(2) button");
    await page.keyboard.press("Enter");
    assert.equal(await page.getAttribute("#columns th:nth-child(2)", "aria-sort"), "ascending");
    const sorted = await names(page);
    await page.keyboard.press("Enter");
    assert.deepEqual(await names(page), sorted.reverse());
    await page.keyboard.press("/");
    await page.keyboard.type("boul");
    assert.deepEqual(await names(page), all.filter(name => name.includes("boul")));
    assert.equal(await page.textContent("#shown"), `1 of ${all.length} scans`);
    await page.fill("#search", "");

    await page.uncheck("#states input[value=done]");
    assert.ok((await states(page)).every(state => state.includes("failed")));
    await page.check("#states input[value=done]");
    assert.equal((await names(page)).length, all.length);

    // Each scan with a dataset leads to its page.
    assert.equal(await page.locator("#rows a").count(), all.length - 1);
    // And has a picture, in which something is drawn.
    const sizes = await page.$$eval("#rows img", images => Promise.all(images.map(async image => {
      await image.decode();
      return image.naturalWidth;
    })));
    assert.deepEqual(sizes, Array(all.length - 1).fill(64));

    // Recognised scenes lead to their pages, too.
    assert.deepEqual(await page.$$eval("#scene-rows th", cells => cells.map(cell => cell.textContent)), scenes);
    assert.equal(await page.locator("#scene-rows a").count(), scenes.length);
    assert.match(await page.textContent("#passed-over"), /1 \.txt/);

    // A narrow page has no heads; a list and a button sort.
    await page.setViewportSize({ width: 390, height: 844 });
    await page.selectOption("#sort", { label: "Name" });
    assert.deepEqual(await names(page), sorted.reverse());
    await page.click("#direction");
    assert.deepEqual(await names(page), sorted.reverse());
    await isUsable(page);

    // Colours: the system's, and the reader's own choice.
    const background = () => page.$eval("body", body => getComputedStyle(body).backgroundColor);
    await page.emulateMedia({ colorScheme: "light" });
    const light = await background();
    await page.emulateMedia({ colorScheme: "dark" });
    assert.notEqual(await background(), light);
    await page.selectOption("#theme", "light");
    assert.equal(await background(), light);
    await page.selectOption("#theme", "auto");
  },

  /// A page of a scan: PAGE and, as JSON, its title.
  async scan(page, wanted) {
    const { title } = JSON.parse(wanted);
    assert.equal(await page.textContent("h1"), title);
    await isDrawn(page);
    const setLevel = level => page.$eval("#level", (slider, value) => {
      slider.value = value;
      slider.dispatchEvent(new Event("input"));
    }, String(level));
    const last = Number(await page.getAttribute("#level", "max"));
    assert.ok(last > 0);
    await setLevel(0);
    const sigma = await page.textContent("#level-text");
    assert.match(sigma, /^0 of \d+, sigma [\d.e+-]+ mm/);
    await changes(page, "the slider", () => setLevel(last));
    assert.notEqual(await page.textContent("#level-text"), sigma);
    await changes(page, "the level back", () => setLevel(0));
    await changes(page, "K", () => page.check("input[name=field][value=K]"));
    assert.match(await page.textContent("#high"), /1\/mm²$/);
    await changes(page, "the palette", () => page.selectOption("#palette", "thesis"));
    await changes(page, "no field", () => page.check("input[name=field][value=none]"));
    for (const box of ["feature-mean", "contour-mean", "contour-gaussian", "wireframe", "rims"]) {
      await changes(page, `${box} on`, () => page.check(`#${box}`));
      await changes(page, `${box} off`, () => page.uncheck(`#${box}`));
    }

    // What is under the cursor, by mouse and by keyboard.
    const box = await page.locator("#canvas").boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    assert.match(await page.textContent("#probe"), /^vertex [\d,]+ of level 0, .*H .* 1\/mm/);
    await page.mouse.move(box.x + 2, box.y + 2);
    assert.match(await page.textContent("#probe"), /^Point at the surface/);
    await page.focus("#canvas");
    await page.keyboard.press("Enter");
    assert.match(await page.textContent("#probe"), /^vertex/);
    await changes(page, "the keyboard", () => page.keyboard.press("ArrowLeft"));
    assert.match(await page.textContent("#python"), /^import h5py\n/);

    // Charts say in words what they show.
    assert.match(await page.getAttribute("#curve svg", "aria-label"), /Recognised at level \d/);
    assert.equal(await page.locator("#histograms svg").count(), 2);
    const histogram = await page.innerHTML("#histograms");
    await setLevel(last);
    assert.notEqual(await page.innerHTML("#histograms"), histogram);
    assert.equal(await page.locator("#levels td", { hasText: "★" }).count(), 1);
    await isUsable(page);
    console.log(await page.textContent("#python"));
  },

  /// The page of a scan in a browser without WebGL: PAGE.
  async plain(page) {
    assert.equal(await page.isVisible("#no-view"), true);
    assert.equal(await page.isVisible("#canvas"), false);
    assert.equal(await page.locator("#curve svg").count(), 1);
    const level = await page.textContent("#level-text");
    await page.focus("#level");
    await page.keyboard.press("Home");
    assert.notEqual(await page.textContent("#level-text"), level);
    assert.match(await page.textContent("#python"), /^import h5py\n/);
  },

  /// The page of a scene: PAGE and, as JSON, its title, the models that were found, and the first matrix.
  async scene(page, wanted) {
    const { title, models, matrix } = JSON.parse(wanted);
    assert.equal(await page.textContent("h1"), title);
    assert.deepEqual(await page.$$eval("#shapes bdi", all => all.map(one => one.textContent)), models);
    assert.deepEqual(await page.$$eval("#object-list h3 bdi", all => all.map(one => one.textContent)), models);
    await isDrawn(page);
    for (const place of models.keys()) {
      await changes(page, `model ${place} off`, () => page.uncheck(`#object-${place}`));
      await changes(page, `model ${place} on`, () => page.check(`#object-${place}`));
    }
    await changes(page, "edges", () => page.check("#edges"));
    await page.uncheck("#edges");
    const setOpacity = value => page.$eval("#opacity", (slider, to) => {
      slider.value = to;
      slider.dispatchEvent(new Event("input"));
    }, String(value));
    await changes(page, "no models", () => setOpacity(0));
    // Without the models the scene shows how far it is from them.
    await changes(page, "a plain scene", () => page.check("input[name=scene][value=plain]"));
    await changes(page, "no scene", () => page.check("input[name=scene][value=hidden]"));
    await changes(page, "distances", () => page.check("input[name=scene][value=distance]"));
    await changes(page, "the distance from fewer models", () => page.uncheck("#object-0"));
    await page.check("#object-0");
    await page.focus("#canvas");
    await changes(page, "the keyboard", () => page.keyboard.press("ArrowLeft"));

    const status = () => page.textContent("#copied");
    for (const [place, kind] of ["text", "JSON"].entries()) {
      const button = page.locator("#object-list article").first().locator("button").nth(place);
      assert.equal(await button.textContent(), `Copy as ${kind}`);
      await page.$eval("#copied", said => said.replaceChildren());
      await button.click();
      await page.waitForFunction(() => document.getElementById("copied").textContent.startsWith("Copied: "));
      const text = await page.evaluate(() => new Promise(done => {
        const field = document.body.appendChild(document.createElement("textarea"));
        field.id = "pasted";
        field.addEventListener("input", () => done(field.value));
        field.focus();
        document.execCommand("paste") || done(undefined);
      })) ?? await button.getAttribute("data-text");
      await page.$eval("#pasted", field => field.remove());
      const rows = kind === "JSON" ? JSON.parse(text) : text.split("\n").map(row => row.split(" ").map(Number));
      assert.deepEqual(rows, matrix);
    }
    assert.match(await status(), /as JSON/);
    const ranked = await page.$$eval("#ranking th", cells => cells.map(cell => cell.textContent));
    for (const model of models) assert.ok(ranked.includes(`${model} ★`), ranked.join());
    await isUsable(page);
  },

  /// Many scans: INDEX and their number.
  async many(page, number) {
    assert.equal((await names(page)).length, Number(number));
    const times = [];
    for (const title of ["Vertices", "Vertices", "Name", "State", "Repairs"]) {
      times.push(await page.evaluate(column => {
        const buttons = [...document.querySelectorAll("#columns button")];
        const begin = performance.now();
        buttons.find(button => button.textContent.startsWith(column)).click();
        document.body.getBoundingClientRect();  // with the new layout
        return performance.now() - begin;
      }, title));
    }
    times.sort((a, b) => a - b);
    console.log(`sorted in ${times.map(time => time.toFixed(0)).join(", ")} ms`);
    // The fastest, because other programs may keep the machine busy.
    assert.ok(times[0] < 200, `the fastest took ${times[0]} ms`);
  },
};

const graphics = check === "plain" ? ["--disable-3d-apis"]
  : ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = await chromium.launch({ executablePath: browserPath,
  args: ["--no-sandbox", "--disable-dev-shm-usage", ...graphics],
});
const complaints = [];
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  page.setDefaultTimeout(60000);
  // three.js complains if there is no WebGL.
  if (check !== "plain") page.on("console", message => complaints.push(`console: ${message.type()}: ${message.text()}`));
  page.on("pageerror", error => complaints.push(`error: ${error.message}`));
  page.on("dialog", dialog => {
    complaints.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  const url = pathToFileURL(given[0]).href;
  page.on("request", request => {
    if (request.url() !== url && !request.url().startsWith("data:")) complaints.push(`request: ${request.url()}`);
  });
  await page.goto(url);
  await checks[check](page, ...given.slice(1));
  assert.deepEqual(complaints, []);
} finally {
  await browser.close();
}
