"use strict";
// Measured heights, truth and deviation side by side, with one zoom, one cursor and one profile. Measured and true
// heights have one scale.
vkfv.parts.push(() => {
    const titles = {measured: "Measured height", truth: "True height", deviation: "Deviation, measured − true"};
    const margin = {left: 48, right: 8, top: 20, bottom: 38};
    const palette = interpolate => d3.range(256).map(k => d3.rgb(interpolate(k / 255)));
    const viridis = palette(d3.interpolateViridis);
    const blueRed = palette(share => d3.interpolateRdBu(1 - share));
    const pixelsOf = colours => Uint32Array.from(colours, ({r, g, b}) => (255 << 24 | b << 16 | g << 8 | r) >>> 0); // little endian
    const pixels = new Map([[viridis, pixelsOf(viridis)], [blueRed, pixelsOf(blueRed)]]);
    const number = vkfv.number;
    let view = d3.zoomIdentity; // in widths of a plot
    let drags = "profile";
    let panels = [];
    let plot = {width: 0, height: 0};

    const map = () => vkfv.chosen.evaluation.map;
    const left = () => map().x0 - map().pitch[0] / 2;
    const low = () => map().y0 - map().pitch[1] / 2;
    const x = () => d3.scaleLinear().domain([left(), left() + map().columns * map().pitch[0]]).range([0, plot.width]);
    const y = () => d3.scaleLinear().domain([low(), low() + map().rows * map().pitch[1]]).range([plot.height, 0]);
    const zoomed = () => d3.zoomIdentity.translate(view.x * plot.width, view.y * plot.width).scale(view.k);

    // The scale from the lowest height to the highest, without the outermost two thousandths at either end.
    function usualScale() {
        const {layers} = map();
        // The heights of some points, which are enough: every point of a small map, one in a prime number of a large
        // one.
        const sorted = (wanted, change = value => value) => {
            const some = [];
            for (const layer of wanted.filter(Boolean)) {
                const heights = vkfv.heights(layer);
                const stride = heights.length > 50000 ? 17 : 1;
                for (let k = 0; k < heights.length; k += stride) {
                    if (Number.isFinite(heights[k])) {
                        some.push(change(heights[k]));
                    }
                }
            }
            return Float32Array.from(some).sort();
        };
        const values = sorted([layers.measured, layers.truth]);
        const [from, to] = [0.002, 0.998].map(share => d3.quantile(values, share));
        const deviations = sorted([layers.deviation], Math.abs);
        const end = deviations.length ? d3.quantile(deviations, 0.99) : 1;
        return {low: Number((values.length ? from : 0).toPrecision(3)), high: Number((values.length ? to : 1).toPrecision(3)),
                deviation: Number((end || 1).toPrecision(3))};
    }

    function colour(panel) {
        const {columns, rows} = map();
        const scale = vkfv.chosen.scale;
        const [from, to, colours] = panel.name === "deviation" ? [-scale.deviation, scale.deviation, blueRed]
                                                               : [scale.low, scale.high, viridis];
        const picture = new ImageData(columns, rows);
        const factor = 255 / (to - from || 1);
        const [to32, of] = [new Uint32Array(picture.data.buffer), pixels.get(colours)];
        for (let row = 0, k = 0; row < rows; ++row) {
            for (let at = (rows - 1 - row) * columns, end = at + columns; at < end; ++at, ++k) {
                const value = panel.values[k];
                if (Number.isFinite(value)) {
                    to32[at] = of[Math.max(0, Math.min(255, Math.round((value - from) * factor)))];
                }
            }
        }
        panel.picture.width = columns;
        panel.picture.height = rows;
        panel.picture.getContext("2d").putImageData(picture, 0, 0);
    }

    function withTicks(axis, count) {
        const values = axis.scale().ticks(Math.max(2, count));
        return axis.tickValues(values).tickFormat(vkfv.ticks(values));
    }

    function drawPanel(panel) {
        const sharp = window.devicePixelRatio || 1;
        const transform = zoomed();
        const canvas = panel.canvas;
        canvas.width = Math.round(plot.width * sharp);
        canvas.height = Math.round(plot.height * sharp);
        const context = canvas.getContext("2d");
        context.imageSmoothingEnabled = transform.k * canvas.width < map().columns;
        context.drawImage(panel.picture, transform.x * sharp, transform.y * sharp, transform.k * canvas.width,
                          transform.k * canvas.height);
        panel.xAxis.call(withTicks(d3.axisBottom(transform.rescaleX(x())), plot.width / 80));
        panel.yAxis.call(withTicks(d3.axisLeft(transform.rescaleY(y())), plot.height / 60));
        drawMarks(panel);
    }

    function drawMarks(panel) {
        const transform = zoomed();
        const [across, up] = [transform.rescaleX(x()), transform.rescaleY(y())];
        const {cursor, profile} = vkfv.chosen;
        const cross = cursor ? `M${across(cursor.x) - 9} ${up(cursor.y)}h18M${across(cursor.x)} ${up(cursor.y) - 9}v18` : null;
        const cut = profile ? `M${across(profile.from.x)} ${up(profile.from.y)}L${across(profile.to.x)} ${up(profile.to.y)}` : null;
        panel.marks.selectAll("path").data([["halo", cut], ["cut", cut], ["halo", cross], ["cross", cross]])
            .join("path").attr("class", d => d[0]).attr("d", d => d[1]);
    }

    // The point of the map at a place of the plot.
    function pointAt([px, py]) {
        const transform = zoomed();
        const {columns, rows, x0, y0, pitch} = map();
        const at = (value, origin, step, count) => Math.max(0, Math.min(count - 1, Math.round((value - origin) / step)));
        const column = at(transform.rescaleX(x()).invert(px), x0, pitch[0], columns);
        const row = at(transform.rescaleY(y()).invert(py), y0, pitch[1], rows);
        return vkfv.mapPoint(column, row);
    }

    function zoomTo(transform) {
        view = transform;
        vkfv.events.call("view");
    }

    const zoom = d3.zoom().scaleExtent([1, 200]).filter(() => {
        const event = d3.event;
        if (event.type === "wheel") {
            return event.ctrlKey || document.activeElement === event.target.closest("svg");
        }
        return drags === "move" && !event.button && !event.shiftKey;
    }).on("zoom", () => {
        const own = d3.event.transform;
        zoomTo(d3.zoomIdentity.translate(own.x / plot.width, own.y / plot.width).scale(own.k));
    });

    function listen(panel) {
        const node = panel.catch.node();
        const place = event => {
            const box = node.getBoundingClientRect();
            return [event.clientX - box.left, event.clientY - box.top];
        };
        let from = null;
        node.addEventListener("pointerdown", event => {
            vkfv.choose("cursor", pointAt(place(event)));
            if (event.button === 0 && (drags === "profile" || event.shiftKey) && event.pointerType !== "touch" || drags === "profile" && event.pointerType === "touch") {
                from = pointAt(place(event));
                node.setPointerCapture(event.pointerId);
            }
        });
        node.addEventListener("pointermove", event => {
            const point = pointAt(place(event));
            vkfv.choose("cursor", point);
            if (from && (point.column !== from.column || point.row !== from.row)) {
                vkfv.choose("profile", {from, to: point});
            }
        });
        for (const end of ["pointerup", "pointercancel"]) {
            node.addEventListener(end, () => { from = null; });
        }
        let begun = null; // begin of a profile that is drawn by keys
        panel.svg.node().addEventListener("keydown", event => {
            const {columns, rows} = map();
            const cursor = vkfv.chosen.cursor;
            const step = event.shiftKey ? 10 : 1;
            const moves = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]};
            const move = moves[event.key];
            if (move) {
                const within = (value, count) => Math.max(0, Math.min(count - 1, value));
                vkfv.choose("cursor", vkfv.mapPoint(within(cursor.column + move[0], columns), within(cursor.row + move[1], rows)));
            } else if (event.key === "+" || event.key === "=") {
                magnify(1.5);
            } else if (event.key === "-") {
                magnify(1 / 1.5);
            } else if (event.key === "0") {
                zoomTo(d3.zoomIdentity);
            } else if (event.key.toLowerCase() === "p" && !event.ctrlKey && !event.metaKey) {
                if (begun) {
                    vkfv.choose("profile", {from: begun, to: cursor});
                }
                begun = begun ? null : cursor;
            } else {
                return;
            }
            event.preventDefault();
        });
    }

    // Zooms about the cursor.
    function magnify(factor) {
        const transform = zoomed();
        const {cursor} = vkfv.chosen;
        const [px, py] = cursor ? [x()(cursor.x), y()(cursor.y)] : [plot.width / 2, plot.height / 2];
        const k = Math.max(1, Math.min(200, transform.k * factor));
        const [sx, sy] = transform.apply([px, py]);
        const within = (value, length) => Math.max(length * (1 - k), Math.min(0, value));
        zoomTo(d3.zoomIdentity.translate(within(sx - px * k, plot.width) / plot.width,
                                         within(sy - py * k, plot.height) / plot.width).scale(k));
    }

    function build() {
        const {layers} = map();
        const place = d3.select("#maps");
        place.selectAll("*").remove();
        panels = Object.keys(titles).filter(name => layers[name]).map(name => {
            const figure = place.append("figure");
            figure.append("figcaption").text(titles[name]);
            const box = figure.append("div").attr("class", "panel");
            const canvas = box.append("canvas").attr("aria-hidden", "true").node();
            const svg = box.append("svg").attr("tabindex", 0).attr("role", "application")
                .attr("aria-label", `${titles[name]} in µm: arrow keys move the point, plus and minus zoom, 0 shows all, P begins and ends the profile`);
            const clip = svg.append("clipPath").attr("id", `clip-${name}`).append("rect");
            const panel = {name, canvas, svg, clip, box, values: vkfv.heights(layers[name]),
                           picture: document.createElement("canvas"), xAxis: svg.append("g"), yAxis: svg.append("g"),
                           bar: figure.append("div").attr("class", "panel"),
                           xLabel: svg.append("text").attr("text-anchor", "end").text("x / µm"),
                           yLabel: svg.append("text").text("y / µm")};
            panel.gaps = panel.values.some(Number.isNaN);
            panel.marks = svg.append("g").attr("clip-path", `url(#clip-${name})`).append("g");
            panel.catch = svg.append("rect").attr("class", "catch");
            svg.call(zoom).on("dblclick.zoom", null);
            listen(panel);
            return panel;
        });
        arrange();
    }

    function arrange() {
        const {columns, rows, pitch} = map();
        const room = Math.max(120, panels[0].box.node().clientWidth - margin.left - margin.right);
        const shape = rows * pitch[1] / (columns * pitch[0]);
        const most = Math.max(240, Math.min(1.3 * room, 0.85 * window.innerHeight));
        plot = shape * room > most ? {width: most / shape, height: most} : {width: room, height: Math.max(12, shape * room)};
        for (const panel of panels) {
            const {width, height} = plot;
            panel.svg.attr("width", width + margin.left + margin.right).attr("height", height + margin.top + margin.bottom);
            const origin = `translate(${margin.left},${margin.top})`;
            panel.clip.attr("width", width).attr("height", height);
            d3.select(panel.marks.node().parentNode).attr("transform", origin);
            panel.catch.attr("transform", origin).attr("width", width).attr("height", height);
            panel.xAxis.attr("transform", `translate(${margin.left},${margin.top + height})`);
            panel.yAxis.attr("transform", origin);
            panel.xLabel.attr("x", margin.left + width).attr("y", margin.top + height + 32);
            panel.yLabel.attr("x", 0).attr("y", 12);
            Object.assign(panel.canvas.style, {left: `${margin.left}px`, top: `${margin.top}px`, width: `${width}px`, height: `${height}px`});
            zoom.extent([[0, 0], [width, height]]).translateExtent([[0, 0], [width, height]]);
        }
        vkfv.events.call("view");
    }

    // Draws the colours of each map under it, as wide as the map, and the meaning of grey.
    function drawBars() {
        const scale = vkfv.chosen.scale;
        for (const panel of panels) {
            const deviation = panel.name === "deviation";
            const [title, domain, colours] = deviation ? ["Deviation / µm", [-scale.deviation, scale.deviation], blueRed]
                                                       : ["Height / µm", [scale.low, scale.high], viridis];
            const {width} = plot, [first, last] = [margin.left, margin.left + width];
            const below = panel.gaps && width < 200; // there is no room beside the title
            const svg = panel.bar.html("").append("svg").attr("width", last + margin.right).attr("height", below ? 80 : 60).attr("role", "img")
                .attr("aria-label", `Colours: ${title}, from ${number(domain[0])} to ${number(domain[1])}; grey: not measured`);
            svg.append("text").attr("x", first).attr("y", 14).text(title);
            svg.selectAll("rect").data(colours).enter().append("rect").attr("x", (d, k) => first + k * width / 256).attr("y", 20)
                .attr("width", width / 256 + 0.6).attr("height", 14).attr("shape-rendering", "crispEdges").attr("fill", d => d);
            svg.append("g").attr("transform", "translate(0,34)")
                .call(withTicks(d3.axisBottom(d3.scaleLinear().domain(domain).range([first, last])), Math.max(4, width / 70)));
            if (panel.gaps) {
                const key = svg.append("g");
                key.append("rect").attr("class", "unmeasured").attr("y", -10).attr("width", 12).attr("height", 12);
                const name = key.append("text").attr("x", 18).text("not measured");
                key.attr("transform", below ? `translate(${first},74)` : `translate(${last - 18 - name.node().getComputedTextLength()},14)`);
            }
        }
        d3.select("#scale-low").property("value", scale.low);
        d3.select("#scale-high").property("value", scale.high);
    }

    function readOut() {
        const point = vkfv.chosen.cursor;
        const names = Object.keys(titles).filter(name => map().layers[name]);
        const values = names.map(name => vkfv.heights(map().layers[name])[point.index]);
        const how = vkfv.form(values);
        const heights = names.map((name, k) =>
            `${{measured: "measured", truth: "true", deviation: "deviation"}[name]} ${vkfv.alike(values[k], how)} µm`);
        d3.select("#readout").text(`x ${number(point.x)} µm, y ${number(point.y)} µm: ${heights.join(", ")}${point.state === "measured" ? "" : `; ${point.state}`}`);
    }

    vkfv.mapPoint = (column, row) => {
        const {columns, x0, y0, pitch, states} = map();
        const index = row * columns + column;
        return {column, row, index, x: x0 + column * pitch[0], y: y0 + row * pitch[1],
                state: vkfv.states[vkfv.blob(states, Uint8Array)[index]]};
    };

    function changed() {
        vkfv.chosen.scale = usualScale();
        const {columns, rows, block} = map();
        vkfv.chosen.cursor = vkfv.mapPoint(Math.floor(columns / 2), Math.floor(rows / 2));
        vkfv.chosen.profile = {from: vkfv.mapPoint(0, Math.floor(rows / 2)), to: vkfv.mapPoint(columns - 1, Math.floor(rows / 2))};
        build();
        const means = block > 1 ? `Shown are ${columns} × ${rows} means over ${block} × ${block} points each; the files have all. ` : "";
        d3.select("#map-note").text(means + (panels.some(panel => panel.gaps) ? "Grey: not measured." : ""));
        vkfv.events.call("scale");
        vkfv.events.call("cursor");
        vkfv.events.call("profile");
    }

    const all = draw => () => panels.forEach(draw);
    vkfv.events.on("view.maps", () => {
        panels.forEach(panel => { panel.svg.node().__zoom = zoomed(); });
        panels.forEach(drawPanel);
    });
    vkfv.events.on("cursor.maps", () => { panels.forEach(drawMarks); readOut(); });
    vkfv.events.on("profile.maps", all(drawMarks));
    vkfv.events.on("scale.maps", () => { panels.forEach(colour); panels.forEach(drawPanel); drawBars(); });
    vkfv.events.on("evaluation.maps", changed);
    vkfv.events.on("resize.maps", () => { arrange(); drawBars(); });
    for (const id of ["scale-low", "scale-high"]) {
        d3.select(`#${id}`).on("change", () => {
            const [from, to] = ["#scale-low", "#scale-high"].map(name => Number(d3.select(name).property("value")));
            if (to > from) {
                vkfv.choose("scale", {...vkfv.chosen.scale, low: from, high: to});
            }
        });
    }
    for (const [id, what] of [["drag-moves", "move"], ["drag-profile", "profile"]]) {
        d3.select(`#${id}`).on("click", () => {
            drags = what;
            d3.select("#drag-moves").attr("aria-pressed", what === "move");
            d3.select("#drag-profile").attr("aria-pressed", what === "profile");
        });
    }
    d3.select("#zoom-in").on("click", () => magnify(1.5));
    d3.select("#zoom-out").on("click", () => magnify(1 / 1.5));
    d3.select("#zoom-all").on("click", () => zoomTo(d3.zoomIdentity));
    if (vkfv.data.evaluations.length > 1) {
        d3.select("#evaluation-label").attr("hidden", null);
        d3.select("#evaluation").on("change", function () { vkfv.choose("evaluation", vkfv.data.evaluations[this.selectedIndex]); })
            .selectAll("option").data(["of the rays' images", "with diffraction"]).enter().append("option").text(d => d);
    }
});
