"use strict";
// Where the light goes, from the source to the detector. What is lost at an element of the way leaves the stream there.
vkfv.parts.push(() => {
    const {emitted, shares} = vkfv.data.ledger;
    const place = document.getElementById("flow");
    if (!place) {
        return;
    }
    const {number} = vkfv;
    const power = name => d3.sum(shares.filter(d => d[0] === name), d => d[1]);
    const ways = [
        ["Illumination", name => / at illumination /.test(name) || name === "beam splitter, towards the specimen"],
        ["Specimen", name => ["beside the specimen", "absorbed by the specimen", "bounce limit", "escaped outside the pupil"].includes(name)],
        ["Imaging", name => / at imaging /.test(name) || ["beam splitter, towards the detector", "beside the detector"].includes(name)],
    ];
    const shown = 3; // of an element's losses, others together
    const notAimed = power("not aimed at");
    const aimed = emitted - notAimed;
    const detected = power("detected");

    function graph() {
        const nodes = [], links = [];
        const node = (name, lost = false) => nodes.push({name, lost}) - 1;
        const used = new Set(["detected", "not aimed at"]);
        let left = aimed;
        let before = node("Source");
        for (const [name, belongs] of ways) {
            const here = node(name);
            links.push({source: before, target: here, value: left});
            const losses = shares.filter(d => belongs(d[0]) && d[1] > 0).sort((a, b) => b[1] - a[1]);
            losses.forEach(d => used.add(d[0]));
            const rest = d3.sum(losses.slice(shown), d => d[1]);
            for (const [loss, value] of [...losses.slice(0, shown), ...(rest > 0 ? [["other losses there", rest]] : [])]) {
                links.push({source: here, target: node(loss, true), value, lost: true});
                left -= value;
            }
            before = here;
        }
        // Of the whole way: what an element of the non-sequential trace ends, and the estimator does not follow.
        const others = shares.filter(d => !used.has(d[0]) && d[1] > 1e-9 * aimed).sort((a, b) => b[1] - a[1]);
        for (const [loss, value] of others.slice(0, 8)) {
            links.push({source: 0, target: node(loss, true), value, lost: true});
            links.filter(link => !link.lost).forEach(link => { link.value -= value; });
        }
        links.push({source: before, target: node("Detector"), value: detected});
        return {nodes, links: links.filter(link => link.value > 0)};
    }

    function draw() {
        const width = Math.max(320, place.clientWidth), narrow = width < 700, height = narrow ? 520 : 420;
        d3.select(place).selectAll("*").remove();
        const svg = d3.select(place).append("svg").attr("width", width).attr("height", height).attr("viewBox", `0 0 ${width} ${height}`)
            .attr("role", "img").attr("aria-label", `Of the light aimed at the instrument ${number(100 * detected / aimed)} % is detected; the table below has every share`);
        const {nodes, links} = d3.sankey().nodeWidth(12).nodePadding(narrow ? 22 : 26).nodeAlign(d3.sankeyLeft)
            .extent([[2, 14], [width - (narrow ? 95 : 280), height - 14]])(graph());
        svg.selectAll("path").data(links).enter().append("path").attr("class", d => d.lost ? "link lost" : "link")
            .attr("d", d3.sankeyLinkHorizontal()).attr("stroke-width", d => Math.max(1.5, d.width));
        svg.selectAll("rect").data(nodes).enter().append("rect").attr("x", d => d.x0).attr("y", d => d.y0)
            .attr("width", d => d.x1 - d.x0).attr("height", d => Math.max(1.5, d.y1 - d.y0));
        const label = svg.selectAll("text").data(nodes).enter().append("text").attr("x", d => d.x1 + 5)
            .attr("y", d => (d.y0 + d.y1) / 2 + 4);
        const room = d => Math.max(12, Math.floor((width - d.x1 - 5) / 6.6)); // letters
        label.append("tspan").text(d => d.name.length > room(d) ? `${d.name.slice(0, room(d) - 1)}…` : d.name);
        label.append("tspan").attr("x", d => d.x1 + 5).attr("dy", "1.15em").text(d => `${number(100 * d.value / aimed, 3)} %`);
    }
    // The backward estimator follows what is detected alone.
    const followed = power("not followed backward") === 0;
    d3.select("#flow-note").text(
        `${number(emitted)} W leave the source` + (notAimed > 0
            ? `, ${number(100 * notAimed / emitted)} % of them in directions that never reach the first element: the streams are of the other ${number(aimed)} W`
            : "") + `; ${number(detected)} W are detected. ` +
        (followed ? "" : "The backward estimator follows no other light: forward tracing tells where it goes."));
    if (followed) {
        vkfv.events.on("resize.light", draw);
        draw();
    }
});
