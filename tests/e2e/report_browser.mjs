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
    assert.ok(times[2] < 200, `the median is ${times[2]} ms`);
  },
};

const browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox", "--disable-gpu"] });
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
