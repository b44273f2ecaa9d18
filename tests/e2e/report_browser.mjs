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

const checks = {
  /// A small archive: INDEX and, as JSON, the names and failures that it must show.
  async index(page, wanted) {
    const { title, names: all, failed, reason, remedy } = JSON.parse(wanted);
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
    const vertices = () => page.$$eval("#rows tr td:nth-child(4)", cells =>
      cells.map(cell => Number(cell.textContent.replace(/,/g, ""))).filter(Number.isFinite));
    const ascending = await vertices();
    assert.ok(ascending.length > 1);
    assert.deepEqual(ascending, [...ascending].sort((a, b) => a - b));
    assert.equal(await page.getAttribute("#columns th:nth-child(4)", "aria-sort"), "ascending");
    await sortBy(page, "Vertices");
    assert.deepEqual(await vertices(), [...ascending].reverse());
    assert.equal(await page.getAttribute("#columns th:nth-child(4)", "aria-sort"), "descending");

    // By keyboard alone: '/' leads to the search.
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
    const pixels = () => page.evaluate(async () => {
      await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
      const from = document.getElementById("canvas");
      const to = Object.assign(document.createElement("canvas"), { width: 480, height: 320 });
      const context = to.getContext("2d");
      context.drawImage(from, 0, 0, 480, 320);
      return [...context.getImageData(0, 0, 480, 320).data];
    });
    /// The share of pixels that differ.
    const difference = (a, b) => {
      let count = 0;
      for (let i = 0; i < a.length; i += 4)
        if ([0, 1, 2].some(c => Math.abs(a[i + c] - b[i + c]) > 12)) ++count;
      return count / (a.length / 4);
    };
    const first = await pixels();
    const corner = first.slice(0, 4);
    const background = first.map((_, i) => corner[i % 4]);
    assert.ok(difference(first, background) > 0.1, "nothing is drawn");

    /// Does something to the page, and expects other pixels.
    const changes = async (what, action) => {
      const before = await pixels();
      await action();
      assert.ok(difference(before, await pixels()) > 0.0005, `${what} changes nothing`);
    };
    const setLevel = level => page.$eval("#level", (slider, value) => {
      slider.value = value;
      slider.dispatchEvent(new Event("input"));
    }, String(level));
    const last = Number(await page.getAttribute("#level", "max"));
    assert.ok(last > 0);
    await setLevel(0);
    const sigma = await page.textContent("#level-text");
    assert.match(sigma, /^0 of \d+, sigma [\d.e+-]+ mm/);
    await changes("the slider", () => setLevel(last));
    assert.notEqual(await page.textContent("#level-text"), sigma);
    await changes("the level back", () => setLevel(0));
    await changes("K", () => page.check("input[name=field][value=K]"));
    assert.match(await page.textContent("#high"), /mm²/);
    await changes("the palette", () => page.selectOption("#palette", "thesis"));
    await changes("no field", () => page.check("input[name=field][value=none]"));
    for (const box of ["feature-mean", "contour-mean", "contour-gaussian", "wireframe", "rims"]) {
      await changes(`${box} on`, () => page.check(`#${box}`));
      await changes(`${box} off`, () => page.uncheck(`#${box}`));
    }

    // What is under the cursor, by mouse and by keyboard.
    const box = await page.locator("#canvas").boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    assert.match(await page.textContent("#probe"), /^vertex [\d,]+ of level 0, .*H .* \/ mm/);
    await page.mouse.move(box.x + 2, box.y + 2);
    assert.match(await page.textContent("#probe"), /^Point at the surface/);
    await page.focus("#canvas");
    await page.keyboard.press("Enter");
    assert.match(await page.textContent("#probe"), /^vertex/);
    await changes("the keyboard", () => page.keyboard.press("ArrowLeft"));
    assert.match(await page.textContent("#python"), /^import h5py\n/);
    console.log(await page.textContent("#python"));
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

const browser = await chromium.launch({ executablePath: browserPath,
  args: ["--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader"],
});
const complaints = [];
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  page.setDefaultTimeout(60000);
  page.on("console", message => complaints.push(`console: ${message.type()}: ${message.text()}`));
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
