// SPDX-License-Identifier: Apache-2.0
// Starts everything once the page is read: plots, tables, pictures, and the page's own buttons.

function storedTheme() {
    try { return localStorage.getItem("relief-theme") || "auto"; } catch { return "auto"; }
}

function setTheme(theme) {
    document.documentElement.dataset.theme = theme;
    try { localStorage.setItem("relief-theme", theme); } catch { /* then it is forgotten */ }
}

function addPageButtons(report) {
    const save = element("button", {type: "button", class: "quiet", onclick: () => {
        const blob = new Blob([JSON.stringify(report, null, 2)], {type: "application/json"});
        const link = element("a", {href: URL.createObjectURL(blob), download: "accuracy.json"});
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    }}, "Save numbers (JSON)");
    const colours = makeSwitch("Colours", [{value: "auto", label: "auto"},
        {value: "light", label: "light"}, {value: "dark", label: "dark"}], storedTheme(), setTheme);
    document.querySelector(".page-buttons").append(colours, save);
}

// Copies; where the browser does not let a page, the text is selected for the reader to do so.
async function copyText(code, button) {
    try {
        await navigator.clipboard.writeText(code.textContent);
        button.textContent = "copied";
    } catch {
        getSelection().selectAllChildren(code);
        button.textContent = "selected";
    }
    setTimeout(() => { button.textContent = "copy"; }, 1500);
}

function addCopyButtons() {
    for (const code of document.querySelectorAll("code.command")) {
        const button = element("button", {type: "button", class: "quiet copy",
            "aria-label": `Copy the command ${code.textContent}`,
            onclick: () => copyText(code, button)}, "copy");
        code.after(button);
    }
}

function makeExperiment(article, experiment) {
    const table = article.querySelector("table.measurements");
    if (table) {
        const scatter = makeScatter(experiment, table);
        table.closest(".scrolled").before(scatter);
        sortable(table, experiment.measurements);
    }
    for (const figure of article.querySelectorAll("figure.chart")) {
        figure.querySelector("details").open = false;
        makeChart(experiment.charts[figure.dataset.chart], figure);
    }
    article.querySelectorAll("figure.pair").forEach(makePair);
}

// The link of the experiment that is being read stands out, in the list of its subject.
function followReading() {
    const links = new Map([...document.querySelectorAll("nav a")].map((link) =>
        [decodeURIComponent(link.hash.slice(1)), link]));
    const observer = new IntersectionObserver((entries) => {
        for (const {target, isIntersecting} of entries) {
            const link = links.get(target.id);
            if (isIntersecting) link?.setAttribute("aria-current", "true");
            else link?.removeAttribute("aria-current");
            if (isIntersecting) openAlone(link?.closest("li li")?.closest("details"));
        }
    }, {rootMargin: "-30% 0px -60% 0px"});
    document.querySelectorAll("article.experiment").forEach((one) => observer.observe(one));
}

function openAlone(list) {
    if (!list) return;
    document.querySelectorAll("nav li details").forEach((one) => { one.open = one === list; });
}

// Of many experiments only the first of each subject is open, and what a link leads to.
const OPEN_AT_MOST = 12;
function closeMost(articles) {
    if (articles.length > OPEN_AT_MOST) {
        for (const article of articles)
            article.querySelector(".body").open = !article.previousElementSibling.matches("article");
    }
    document.querySelectorAll("nav li details").forEach((one, index) => { one.open = index === 0; });
    const openTarget = () => {
        const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
        const body = target?.querySelector(":scope > .body");
        if (body) body.open = true;
    };
    addEventListener("hashchange", openTarget);
    openTarget();
}

document.addEventListener("DOMContentLoaded", () => {
    const report = JSON.parse(document.getElementById("report").textContent);
    setTheme(storedTheme());
    addPageButtons(report);
    addCopyButtons();
    if (!matchMedia("(min-width: 70rem)").matches)
        document.querySelectorAll("nav > details, .machine").forEach((one) => { one.open = false; });
    const articles = [...document.querySelectorAll("article.experiment")];
    closeMost(articles);
    for (const article of articles)
        makeExperiment(article, report.experiments[article.dataset.experiment]);
    followReading();
    // Plots are drawn when the page has been laid out: once the next frame has begun, they stand.
    requestAnimationFrame(() => requestAnimationFrame(() => {
        document.documentElement.dataset.ready = "true";
    }));
});
