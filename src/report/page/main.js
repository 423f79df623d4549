"use strict";
// Everything begins once every part is there.
vkfv.parts.forEach(part => part());
vkfv.events.call("evaluation");
{
    let width = window.innerWidth;
    const again = () => { width = window.innerWidth; vkfv.events.call("resize"); };
    window.addEventListener("resize", () => { if (window.innerWidth !== width) { again(); } });
    window.matchMedia("print").addListener(again);
    window.addEventListener("beforeprint", again);
    window.addEventListener("afterprint", again);
}
document.documentElement.dataset.ready = "yes";
