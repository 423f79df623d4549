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
document.documentElement.dataset.ready = "yes";
