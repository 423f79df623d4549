"use strict";
// Everything begins once every part is there.
vkfv.parts.forEach(part => part());
vkfv.events.call("evaluation");
// Tables and drawings that are wider than the page say so.
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
