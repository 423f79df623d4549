"use strict";
// The flow of light from the source to the detector. Light that is lost at an element leaves the stream there.
vkfv.parts.push(() => {
    const {emitted, shares, rays} = vkfv.data.ledger;
    const place = document.getElementById("flow");
    if (!place) {
        return;
    }
    const {figure} = vkfv;
    const power = name => d3.sum(shares.filter(d => d[0] === name), d => d[1]);
    const ways = [
        ["Illumination", name => / at illumination /.test(name) || name === "beam splitter, towards the specimen"],
        ["Specimen", name => ["beside the specimen", "absorbed by the specimen", "bounce limit", "escaped outside the pupil"].includes(name)],
        ["Imaging", name => / at imaging /.test(name) || ["beam splitter, towards the detector", "beside the detector"].includes(name)],
    ];
    const shown = 3; // losses of an element; others are put together
    const narrowest = 760; // px, for streams with their labels
    const notAimed = power("not aimed at");
    const aimed = emitted - notAimed;
    const detected = power("detected");
    const percent = value => `${figure(100 * value / aimed, 3)} %`;

    // Source, elements and detector as [{name, arriving, losses: [[name, power] ...]} ...].
    function stations() {
        const used = new Set(["detected", "not aimed at"]);
        const found = ways.map(([name, belongs]) => {
            const losses = shares.filter(d => belongs(d[0]) && d[1] > 0).sort((a, b) => b[1] - a[1]);
            losses.forEach(d => used.add(d[0]));
            const rest = d3.sum(losses.slice(shown), d => d[1]);
            return {name, losses: [...losses.slice(0, shown), ...(rest > 0 ? [["other losses there", rest]] : [])]};
        });
        // These losses belong to no element: light that an element ends in the non-sequential trace.
        const others = shares.filter(d => !used.has(d[0]) && d[1] > 1e-9 * aimed).sort((a, b) => b[1] - a[1]).slice(0, 8);
        const all = [{name: "Source", losses: others}, ...found, {name: "Detector", losses: []}];
        let left = aimed;
        for (const one of all) {
            one.arriving = one.name === "Detector" ? detected : left;
            left -= d3.sum(one.losses, d => d[1]);
        }
        return all;
    }

    function graph(all) {
        const nodes = all.map(({name}) => ({name})), links = [];
        all.forEach(({losses}, k) => {
            if (k + 1 < all.length) {
                links.push({source: k, target: k + 1, value: all[k + 1].arriving});
            }
            for (const [name, value] of losses) {
                links.push({source: k, target: nodes.push({name, lost: true}) - 1, value, lost: true});
            }
        });
        return {nodes, links: links.filter(link => link.value > 0)};
    }

    // The words in lines of at most this number of letters.
    function wrapped(text, letters) {
        const lines = [""];
        for (const word of text.split(" ")) {
            const last = lines[lines.length - 1];
            if (last && last.length + 1 + word.length > letters) {
                lines.push(word);
            } else {
                lines[lines.length - 1] = last ? `${last} ${word}` : word;
            }
        }
        return lines;
    }

    // The stream runs along the top, under its own labels. Losses leave downwards, those of an element in the room
    // before the next element.
    function streams(all) {
        const width = Math.min(1500, place.clientWidth), bar = 12, top = 42, line = 15, letter = 7;
        const svg = d3.select(place).append("svg").attr("width", width).attr("role", "img")
            .attr("aria-label", `Of the light aimed at the instrument ${percent(detected)} is detected; the table below has every share`);
        const sankey = d3.sankey().nodeWidth(bar).nodePadding(0).nodeSort(null).linkSort(null).extent([[0, top], [width, top + 240]]);
        const laid = sankey(graph(all));
        const main = laid.nodes.filter(node => !node.lost);
        const rooms = main.map(node => node.sourceLinks.some(link => link.lost) ? 1 : 0.4).slice(0, -1);
        const unit = (width - 4 - bar - 40) / d3.sum(rooms); // the label of the last element is wider than its bar
        let x = 2, lowest = top;
        main.forEach((node, k) => {
            const high = node.y1 - node.y0;
            Object.assign(node, {x0: x, x1: x + bar, y0: top, y1: top + high});
            const begin = x + bar + 0.3 * (unit - bar);
            const lost = node.sourceLinks.filter(link => link.lost).map(link => link.target);
            let y = top + (main[k + 1] ? main[k + 1].y1 - main[k + 1].y0 : 0) + 16;
            for (const target of lost) {
                const thick = target.y1 - target.y0;
                target.lines = [...wrapped(target.name, Math.max(8, Math.floor((x + unit - begin - bar - 14) / letter))), percent(target.value)];
                const tall = Math.max(thick, line * target.lines.length);
                Object.assign(target, {x0: begin, x1: begin + bar, y0: y + (tall - thick) / 2, y1: y + (tall + thick) / 2});
                y += tall + 10;
            }
            lowest = Math.max(lowest, node.y1, y);
            x += unit * (rooms[k] || 0);
        });
        sankey.update(laid);
        svg.attr("height", lowest + 6).attr("viewBox", `0 0 ${width} ${lowest + 6}`);
        // Links are areas, since wide lines that bend would fold.
        const bend = d3.interpolateNumber;
        const area = d3.area().x(d => d.x).y0(d => d.y - d.half).y1(d => d.y + d.half);
        svg.selectAll("path").data(laid.links).enter().append("path").attr("class", d => d.lost ? "link lost" : "link")
            .attr("d", d => area(d3.range(33).map(k => ({x: bend(d.source.x1, d.target.x0)(k / 32),
                                                         y: bend(d.y0, d.y1)(d3.easeCubicInOut(k / 32)),
                                                         half: Math.max(0.75, d.width / 2)}))));
        svg.selectAll("rect").data(laid.nodes).enter().append("rect").attr("x", d => d.x0).attr("y", d => d.y0)
            .attr("width", bar).attr("height", d => Math.max(1.5, d.y1 - d.y0));
        for (const node of laid.nodes) {
            const lines = node.lost ? node.lines : [node.name, percent(node.value)];
            const y = node.lost ? (node.y0 + node.y1 - line * lines.length) / 2 + 12 : top - 6 - line;
            svg.append("text").selectAll("tspan").data(lines).enter().append("tspan").attr("x", node.lost ? node.x1 + 6 : node.x0)
                .attr("y", (unused, k) => y + k * line).text(d => d);
        }
    }

    // Bars for places where streams have no room. The bar of a loss lies at the end of the part that is left of the bar
    // above.
    function bars(all) {
        const list = d3.select(place).append("ol").attr("class", "losses");
        const row = (name, from, to, lost) => {
            const item = list.append("li").attr("class", lost ? "lost" : null);
            item.append("span").text(name);
            item.append("span").attr("class", "share").text(percent(to - from));
            item.append("span").attr("class", "bar").append("span").style("margin-left", `${Math.max(0, 100 * from / aimed)}%`)
                .style("width", `${100 * (to - from) / aimed}%`);
        };
        for (const {name, arriving, losses} of all) {
            row(name, 0, arriving, false);
            let left = arriving;
            for (const [loss, value] of losses) {
                row(loss, left - value, left, true);
                left -= value;
            }
        }
    }

    function draw() {
        d3.select(place).selectAll("*").remove();
        (place.clientWidth < narrowest ? bars : streams)(stations());
    }
    d3.select("#flow-note").text(
        `${vkfv.number(emitted)} W leave the source` + (notAimed > 0
            ? `, ${figure(100 * notAimed / emitted)} % of them in directions that cannot pass the illuminator: shares are of the other ${figure(aimed)} W`
            : "") + `; ${figure(detected)} W are detected.` +
        (rays > 0 ? ` Found by ${rays} rays that were traced forward: the images' own paths follow only light that is detected.` : ""));
    vkfv.events.on("resize.light", draw);
    draw();
});
