// What holds of every state of the page, whatever is open; each check gives a line for what does not.
import { readFileSync } from "node:fs";
import { headCt, open, quick, sample, samples } from "./page.mjs";

/** axe-core, to be evaluated in a page: it then has window.axe. */
const axeSource = readFileSync(new URL("../../web/node_modules/axe-core/axe.min.js", import.meta.url), "utf8");

/** The page with something to show in every panel, where the sample data is there: labels, and an animation. */
export async function openFull(t, options = {}) {
  const atlas = sample("aal.nii.gz");
  const volume = sample("mri-brain.nii.gz") ?? headCt;
  const args = [volume, ...(atlas ? ["--labels", atlas] : []), ...quick, "--turntable"];
  const viewer = await open(t, args, { ...options, folder: atlas ? samples : undefined });
  await viewer.done();
  return viewer;
}

export const panelTitles = (page) =>
  page.getByLabel("Panels", { exact: true }).getByRole("button").evaluateAll((buttons) => buttons.map((button) => button.getAttribute("aria-label")));

/** Shows all that is in the open panel. */
async function unfold(page) {
  const edit = page.getByRole("button", { name: "Edit single labels" });
  if (await edit.count()) await edit.click();
  const folded = page.locator(".dock :not(.label-row) > [aria-expanded=false]");
  while (await folded.count()) await folded.first().click();
  // Of labels one is open at a time.
  const label = page.locator(".label-row .name[aria-expanded=false]");
  if (await label.count()) await label.first().click();
}

/** Calls `check` with the name of each state that the page comes to: every panel whole, menus, tools, slices, dialogs. */
async function eachState(viewer, check) {
  const { page } = viewer;
  await check("no panel");
  for (const title of await panelTitles(page)) {
    await viewer.panel(title);
    await page.getByRole("complementary", { name: title }).waitFor();
    await unfold(page);
    await check(title);
  }
  for (const menu of ["Save the picture", "Scene file", "Resolution and theme"]) {
    await viewer.button(menu).click();
    await check(menu);
    await page.keyboard.press("Escape");
  }
  for (const [key, tool] of [["m", "Click two points"], ["c", "Drag a face"]]) {
    await page.keyboard.press(key);
    await page.getByText(tool).waitFor();
    await check(tool);
    await page.keyboard.press(key);
  }
  await page.keyboard.press("s");
  await page.getByRole("toolbar", { name: "Slices" }).waitFor();
  await check("slices");
  await viewer.panel("Transfer function");
  await check("slices and a panel");
  await page.keyboard.press("Control+o");
  await page.getByRole("dialog", { name: "Open" }).waitFor();
  await check("the dialog that opens files");
  await page.keyboard.press("Escape");
  await page.keyboard.press("?");
  await page.getByRole("dialog", { name: "Keys and gestures" }).waitFor();
  await check("help");
}

/** What any of `checks`, functions of the page, finds in any state of it: "state: what". */
export async function troubles(viewer, checks) {
  const found = new Set();
  await eachState(viewer, async (where) => {
    for (const check of checks) for (const what of await check(viewer.page)) found.add(`${where}: ${what}`);
  });
  return [...found];
}

/** What axe-core finds against WCAG 2.1 A and AA, one line for each element. */
export async function violations(page) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(axeSource);
  return page.evaluate(async () => {
    const { violations: found } = await window.axe.run({ runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"], resultTypes: ["violations"] });
    return found.flatMap(({ id, nodes }) => nodes.map(({ html, any }) => `${id}: ${html.slice(0, 160)} ${any[0]?.message ?? ""}`));
  });
}

/** What reaches beyond the window, or is wider than the panel it is in. */
export function overflowing(page) {
  return page.evaluate(() => {
    const out = [];
    const { documentElement: whole } = document;
    if (whole.scrollWidth > innerWidth || whole.scrollHeight > innerHeight) out.push("the page");
    for (const dock of document.querySelectorAll(".dock")) {
      const { left, right, top, bottom } = dock.getBoundingClientRect();
      if (left < 0 || top < 0 || right > innerWidth || bottom > innerHeight) out.push(`the panel ${dock.getAttribute("aria-label")}`);
      const body = dock.querySelector(".dock-body");
      if (body.scrollWidth > body.clientWidth) out.push(`what is in ${dock.getAttribute("aria-label")}`);
    }
    return out;
  });
}

/** Controls that cannot be brought into sight whole, or that something else lies over. Handles in the picture and in
 * the editors are left out: they may lie over one another. */
export function unreachable(page) {
  return page.evaluate(() => {
    const out = [];
    const top = document.querySelector("dialog[open]") ?? document.querySelector(".menu-list") ?? document.body;
    for (const control of top.querySelectorAll("button, input, select, a[href], [tabindex='0']")) {
      if (control.closest("svg, [inert]") || !control.checkVisibility({ visibilityProperty: true })) continue;
      control.scrollIntoView({ block: "nearest", inline: "nearest" });
      // What is hidden outside of an element can be brought in by a program, and by nobody else.
      for (let around = control.parentElement; around; around = around.parentElement)
        if (getComputedStyle(around).overflowY === "hidden") around.scrollTop = 0;
      for (let around = control.parentElement; around; around = around.parentElement)
        if (getComputedStyle(around).overflowX === "hidden") around.scrollLeft = 0;
      const { left, right, top: above, bottom, width, height } = control.getBoundingClientRect();
      const what = control.getAttribute("aria-label") ?? control.labels?.[0]?.textContent ?? control.textContent;
      if (left < -1 || above < -1 || right > innerWidth + 1 || bottom > innerHeight + 1)
        out.push(`${what} is cut off: ${[left, above, right, bottom].map(Math.round)}`);
      const hit = document.elementFromPoint(left + width / 2, above + height / 2);
      const own = hit && (control.contains(hit) || hit.contains(control) || hit.closest("label")?.control === control);
      if (!own) out.push(`${what} lies under ${hit?.outerHTML.slice(0, 80)}`);
    }
    return out;
  });
}
