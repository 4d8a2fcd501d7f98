#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Looks at the page of sample_report.json in a browser without a window: report_page_test.py PAGE.

Exits with 77 where there is no browser (Debian's chromium and chromium-driver). Run by
report_page_test.cpp, which makes the page.
"""
import json
import pathlib
import sys
import unittest

import browser

PAGE = None
REPORT = json.loads((pathlib.Path(__file__).parent / "sample_report.json").read_text())
METHODS = REPORT["experiments"][0]["measurements"]
TIP = "const tip = document.getElementById('tip'); return tip.hidden ? null : tip.innerText;"

# The least contrast [WCAG 2.1, 1.4.3] of any text with what it stands on; and which text that is.
CONTRAST = """
const light = (c) => { c /= 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; };
const parts = (text) => (text.match(/[\\d.]+/g) || []).map(Number);
const luminance = ([r, g, b]) => 0.2126 * light(r) + 0.7152 * light(g) + 0.0722 * light(b);
const isClear = (text) => { const all = parts(text); return all.length === 4 && all[3] === 0; };
let worst = [99, ""];
for (const node of document.querySelectorAll("body *")) {
    const own = [...node.childNodes].some((c) => c.nodeType === 3 && c.data.trim() !== "");
    if (!own || node.closest("script, noscript, .unseen, .skip, [hidden]")) continue;
    if (node.getClientRects().length === 0) continue;
    const style = getComputedStyle(node);
    let behind = node;
    while (behind.parentElement && isClear(getComputedStyle(behind).backgroundColor))
        behind = behind.parentElement;
    const ink = luminance(parts(node.closest("svg") ? style.fill : style.color));
    const paper = luminance(parts(getComputedStyle(behind).backgroundColor));
    const contrast = (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05);
    if (contrast < worst[0]) worst = [contrast, node.outerHTML.slice(0, 100)];
}
return worst;
"""


class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = browser.Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()

    def setUp(self):
        self.browser.resize(1280, 900)
        self.browser.prefer(color_scheme="light", reduced_motion="reduce")
        self.browser.log("performance")
        self.browser.log("browser")
        self.open_page()

    def tearDown(self):
        self.assertEqual(self.browser.log("browser"), [], "the console has messages")

    def run_script(self, script, *arguments):
        return self.browser.run(script, *arguments)

    def count(self, selector):
        return self.run_script("return document.querySelectorAll(arguments[0]).length", selector)

    def open_page(self):
        """Until its script has run."""
        self.browser.open(PAGE)
        self.browser.wait_for("return document.documentElement.dataset.ready === 'true'")

    def first_scatter(self, selector):
        return f"#normals\\/sample .scatter {selector}"

    def efficient(self):
        """The methods that are marked as efficient, by increasing cost."""
        shown = self.run_script("""return [...document.querySelectorAll(arguments[0])]
            .map((point) => Number(point.dataset.index))""", self.first_scatter(".point.efficient"))
        return [METHODS[index]["method"] for index in shown]

    def shown_texts(self, selector):
        return self.run_script("""return [...document.querySelectorAll(arguments[0])]
            .filter((text) => text.getClientRects().length > 0).map((text) => text.textContent)""", selector)

    def middle_of(self, selector, index=0):
        """Scrolls an element into view; where its middle then is in the window."""
        return self.run_script("""
            const node = document.querySelectorAll(arguments[0])[arguments[1]];
            node.scrollIntoView({block: "center"});
            const box = node.getBoundingClientRect();
            return [box.x + box.width / 2, box.y + box.height / 2];""", selector, index)

    def click(self, selector, index=0):
        self.run_script("document.querySelectorAll(arguments[0])[arguments[1]].click()", selector, index)

    def point(self, method):
        index = [one["method"] for one in METHODS].index(method)
        return self.first_scatter(f'.point[data-index="{index}"]')

    def test_asks_for_nothing_but_itself(self):
        asked = [address for address in self.browser.requests() if not address.startswith("data:")]
        self.assertEqual(asked, [PAGE.resolve().as_uri()])

    def test_plots_have_a_point_for_each_measurement(self):
        for experiment in REPORT["experiments"]:
            drawn = self.count(f'article[id="{experiment["id"]}"] .scatter .point')
            self.assertEqual(drawn, len(experiment["measurements"]), experiment["id"])
        points = sum(len(curve["points"]) for chart in REPORT["experiments"][0]["charts"]
                     for curve in chart["curves"])
        self.assertEqual(self.count(".chart .point"), points)

    def test_the_frontier_is_what_the_report_says(self):
        marked = [one["method"] for one in METHODS if one["efficient"]]
        self.assertEqual(self.efficient(), marked)
        line = self.run_script("return document.querySelector(arguments[0]).getAttribute('d')",
                               self.first_scatter(".frontier"))
        self.assertEqual(line.count("H"), len(marked), "a step a method and the way out")
        self.assertEqual(self.shown_texts(self.first_scatter(".point-label")), marked)

    def test_what_has_no_place_on_an_axis_lies_in_a_strip(self):
        words = self.shown_texts(self.first_scatter(".strips text"))
        self.assertEqual(sorted(words), ["exact", "no result", "not timed"])
        place = """const box = document.querySelector(arguments[0]).getBoundingClientRect();
            return [box.x + box.width / 2, box.y + box.height / 2]"""
        broken = self.run_script(place, self.point("broken") + " .mark")
        exact = self.run_script(place, self.point("closed form") + " .mark")
        worst = self.run_script(place, self.point("area, float32") + " .mark")
        best = self.run_script(place, self.point("angle, float32") + " .mark")
        self.assertLess(broken[1], worst[1])
        self.assertGreater(exact[1], best[1])
        self.assertGreater(exact[0], best[0], "to the right of all times")

    def test_pointing_at_a_method_tells_its_numbers(self):
        self.browser.move(*self.middle_of(self.point("max, float32") + " .mark"))
        told = self.run_script(TIP)
        for word in ["max, float32", "0.123 degrees", "0.0900 degrees", "2.00 ms", "1.20 ms",
                     "244 ns, one thread", "the fastest of those below a degree"]:
            self.assertIn(word, told)
        self.browser.move(1, 1)
        self.assertIsNone(self.run_script(TIP))

    def test_the_keyboard_goes_from_method_to_method(self):
        self.run_script("document.querySelector(arguments[0]).focus()",
                        self.first_scatter('.point[tabindex="0"]'))
        self.assertIn("broken", self.run_script(TIP))  # The fastest.
        self.browser.press("ArrowRight")
        self.assertIn("area, float32", self.run_script(TIP))
        rings = self.run_script("""return [...document.querySelectorAll('.point')].filter((point) =>
            getComputedStyle(point.querySelector('.reach')).stroke !== 'none')
            .map((point) => point === document.activeElement)""")
        self.assertEqual(rings, [True], "the point with the focus has a ring, and no other")
        self.browser.press("End")
        self.assertIn("closed form", self.run_script(TIP))  # Not timed: at the right end.
        self.browser.press("Escape")
        self.assertIsNone(self.run_script(TIP))
        label = self.run_script("return document.activeElement.getAttribute('aria-label')")
        self.assertIn("closed form: RMS: 0 degrees", label)

    def test_filters_hide_points_and_rows(self):
        self.click(self.first_scatter(".choice input"), 0)  # weighting: area
        self.assertEqual(self.count(self.first_scatter(".point:not(.hidden)")), 4)
        self.assertEqual(self.count("#normals\\/sample tbody tr[data-index]:not(.hidden)"), 4)
        self.assertEqual(self.shown_texts(self.first_scatter(".point-label")), ["max, float32"])
        self.click(self.first_scatter(".choice input"), 0)
        self.assertEqual(self.count(self.first_scatter(".point:not(.hidden)")), 6)

    def test_without_times_the_size_is_the_cost(self):
        self.assertEqual(self.shown_texts("#storage\\/sample .axis-name")[0], "stored size →")

    def test_tables_are_sorted_by_a_column(self):
        head = "#normals\\/sample thead .sort"
        order = """return [...document.querySelectorAll('#normals\\\\/sample .measurements tbody tr')]
            .map((row) => Number(row.dataset.index))"""
        self.click(head, 1)  # RMS
        self.assertEqual(self.run_script(order), [4, 3, 2, 0, 1, 5], "no number comes last")
        self.click(head, 1)
        self.assertEqual(self.run_script(order), [0, 1, 2, 3, 4, 5])
        sort = "return document.querySelectorAll(arguments[0])[1].closest('th').ariaSort"
        self.assertEqual(self.run_script(sort, head), "descending")

    def test_charts_have_slopes_bounds_and_breaks(self):
        chips = self.run_script("""return [...document.querySelectorAll('.chart .chip')]
            .map((chip) => chip.innerText.replace(/\\s+/g, ' ').trim())""")
        self.assertEqual(chips, ["max slope −2.00, theory −2", "area slope −1.00, theory −1",
                                 "float32 breaks at 10⁻¹⁵", "exact"])
        self.assertEqual(self.count(".chart .fit"), 2)
        self.assertEqual(self.count(".chart .bound"), 1)
        self.assertEqual(self.count(".chart .breaks"), 1)
        # The points of this curve lie on a line of its slope: so does the line that is drawn.
        gap = self.run_script("""
            const [line, ...points] = document.querySelectorAll('.chart svg [data-index="0"]:is(.fit, .point)');
            const at = points[0].getAttribute('transform').match(/[\\d.]+/g).map(Number);
            return [line.x1.baseVal.value - at[0], line.y1.baseVal.value - at[1]]""")
        self.assertLess(max(map(abs, gap)), 0.11)  # Coordinates have one decimal.
        self.browser.move(*self.middle_of(".chart .point", 1))
        self.assertIn("0.400", self.run_script(TIP))
        self.click(".chart .chip input", 0)
        self.assertEqual(self.count(".chart .point:not(.hidden)"), 12)
        self.assertEqual(self.count(".chart .fit:not(.hidden)"), 1)

    def test_the_line_between_pictures_moves(self):
        value = "return Number(document.querySelector('.sides input').value)"
        clip = "return getComputedStyle(document.querySelector('.after')).clipPath"
        self.assertEqual(self.run_script(value), 50)
        x, y = self.middle_of(".sides input")
        width = self.run_script("return document.querySelector('.sides').clientWidth")
        self.browser.drag((x, y), (x + 20, y), (x + width / 4, y))
        dragged = self.run_script(value)
        self.assertAlmostEqual(dragged, 75, delta=3)
        self.assertIn(f"{dragged}%", self.run_script(clip))
        self.browser.press("ArrowLeft")  # The drag left the focus on it.
        self.assertEqual(self.run_script(value), dragged - 1)
        self.browser.press("Home")
        self.assertEqual(self.run_script(value), 0)
        self.click(".pair label input")
        blend = "return getComputedStyle(document.querySelector('.after')).mixBlendMode"
        self.assertEqual(self.run_script(blend), "difference")

    def test_a_phone_does_not_scroll_sideways(self):
        for width in (320, 390):
            self.browser.resize(width, 844, is_phone=True)
            self.open_page()
            widths = self.run_script("return [document.documentElement.scrollWidth, innerWidth]")
            self.assertEqual(widths, [width, width])
        self.assertEqual(self.count(self.first_scatter(".point")), len(METHODS))

    def test_texts_stand_out_in_light_and_in_dark(self):
        paper = "return getComputedStyle(document.body).backgroundColor"
        light = self.run_script(paper)
        contrast, text = self.run_script(CONTRAST)
        self.assertGreaterEqual(contrast, 4.5, f"light: {text}")
        self.browser.prefer(color_scheme="dark")
        self.assertNotEqual(self.run_script(paper), light)
        contrast, text = self.run_script(CONTRAST)
        self.assertGreaterEqual(contrast, 4.5, f"dark: {text}")

    def test_headings_labels_and_tables_are_in_order(self):
        levels = self.run_script("""return [...document.querySelectorAll('h1, h2, h3, h4')]
            .map((heading) => Number(heading.tagName[1]))""")
        self.assertEqual(levels[0], 1)
        self.assertTrue(all(b <= a + 1 for a, b in zip(levels, levels[1:])), levels)
        self.assertEqual(self.run_script("""return [...document.querySelectorAll('th')]
            .filter((cell) => !cell.scope).length"""), 0)
        self.assertEqual(self.count("table"), self.count("table > caption"))
        self.assertEqual(self.count("img"), self.count('img[alt]:not([alt=""])'))
        nameless = self.run_script("""return [...document.querySelectorAll(
            'button, input, summary, a[href], [tabindex="0"]')].filter((node) =>
            !(node.ariaLabel || node.textContent.trim() || node.closest('label')?.textContent.trim()))
            .map((node) => node.outerHTML.slice(0, 80))""")
        self.assertEqual(nameless, [])

    def test_without_a_script_all_plots_tables_and_pictures_are_there(self):
        self.browser.devtools("Emulation.setScriptExecutionDisabled", value=True)
        try:
            self.browser.open(PAGE)
        finally:
            self.browser.devtools("Emulation.setScriptExecutionDisabled", value=False)
        charts = sum(len(experiment["charts"]) for experiment in REPORT["experiments"])
        self.assertEqual(self.count(".plot svg"), len(REPORT["experiments"]) + charts)
        self.assertEqual(self.count(".chip .mark"), 15)
        self.assertEqual(self.shown_texts(".pair label"), [], "a switch without a script is hidden")
        self.assertEqual(self.count(".hint"), 1)
        self.assertEqual(self.count("table.measurements"), len(REPORT["experiments"]))
        self.assertTrue(self.run_script("""return [...document.images].every((picture) =>
            picture.naturalWidth === 64 && picture.getClientRects().length === 1)"""))


if __name__ == "__main__":
    if browser.programs() is None:
        print("needs a browser: Debian's chromium and chromium-driver", file=sys.stderr)
        sys.exit(77)
    PAGE = pathlib.Path(sys.argv.pop(1))
    unittest.main()
