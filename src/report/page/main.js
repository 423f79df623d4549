"use strict";
// This script comes last, and runs the parts when all of them are there.
vkfv.parts.forEach(part => part());
vkfv.events.call("evaluation");
// Marks the tables and drawings that are wider than the page.
const showWide = () => document.querySelectorAll(".wide").forEach(place => {
    place.toggleAttribute("data-more", place.scrollWidth > place.clientWidth + 1);
});
vkfv.events.on("resize.wide", showWide);
showWide();
{
    let width = window.innerWidth;
    const again = () => { width = window.innerWidth; vkfv.events.call("resize"); };
    window.addEventListener("resize", () => { if (window.innerWidth !== width) { again(); } });
    window.matchMedia("print").addListener(again);
    window.addEventListener("beforeprint", again);
    window.addEventListener("afterprint", again);
}
{
    // The page's bytes have no date, so that equal stacks have equal pages; the file has one.
    const written = new Date(document.lastModified);
    const day = [written.getFullYear(), written.getMonth() + 1, written.getDate()].map(part => String(part).padStart(2, "0")).join("-");
    const summary = document.getElementById("summary");
    if (summary !== null) { summary.textContent += ` Written on ${day}.`; }
}
document.documentElement.dataset.ready = "yes";
