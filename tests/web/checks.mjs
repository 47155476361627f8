// What holds of every state of the page, whatever is open; each gives a line for what does not.

/** What axe-core finds against WCAG 2.1 A and AA, one line for each element. The unit beside a number that cannot be
 * changed is left out: what is disabled may be faint, and axe-core does not know that it belongs to it. */
export async function violations(page) {
  return page.evaluate(async () => {
    const { violations: found } = await window.axe.run({ exclude: [".disabled .unit"] }, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"], resultTypes: ["violations"] });
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
