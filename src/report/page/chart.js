"use strict";
// The width (px) of a text that is shown. Widths are kept, since asking the browser costs a layout, which would be at
// every image that plays.
vkfv.textWidth = (() => {
    const known = new Map();
    return node => {
        const text = node.textContent;
        const width = known.get(text) || node.getComputedTextLength();
        known.set(text, width);
        return width;
    };
})();

// Draws curves over two axes, as wide as their place, and again when that width changes. content() returns null if there is
// nothing to draw, otherwise {x: {label, domain, log}, y: {label, domain, zero}, series: [{name, points: [[x, y] ...], kind, dots}],
// marks: [{x, name, quiet}], height}. A y of NaN leaves a gap. kind: "line" (default), "steps".
vkfv.chart = (place, label, content) => {
    const element = d3.select(place);
    const styles = 6; // series in page.css
    const line = 18; // px, of text
    const margin = {right: 16, bottom: 44, left: 62};

    function padded([low, high]) {
        const pad = high > low ? 0.04 * (high - low) : Math.abs(low) * 0.05 || 1;
        return [low - pad, high + pad];
    }

    // Writes the names in a row behind the axis' title, or in rows below it where there is no room. Returns the number
    // of rows.
    function legend(svg, series, title, right) {
        const named = series.map((one, k) => ({name: one.name, style: one.colour || k % styles + 1})).filter(one => one.name);
        const entries = named.map(one => {
            const group = svg.append("g");
            group.append("line").attr("class", `series series-${one.style}`).attr("x2", 24).attr("y1", -4).attr("y2", -4);
            const width = 30 + vkfv.textWidth(group.append("text").attr("x", 30).text(one.name).node());
            return {group, width};
        });
        const gap = 16;
        const all = d3.sum(entries, d => d.width + gap);
        const after = 4 + vkfv.textWidth(title.node()) + gap;
        if (after + all <= right) {
            let x = right - all + gap;
            for (const {group, width} of entries) {
                group.attr("transform", `translate(${x},14)`);
                x += width + gap;
            }
            return 1;
        }
        let x = 4, row = 1;
        for (const {group, width} of entries) {
            if (x > 4 && x + width > right) {
                x = 4;
                row += 1;
            }
            group.attr("transform", `translate(${x},${14 + row * line})`);
            x += width + gap;
        }
        return row + 1;
    }

    function axisTicks(scale, log, count) {
        if (!log) {
            const values = scale.ticks(count);
            return {values, written: vkfv.ticks(values)};
        }
        const decades = scale.ticks(50).filter(value => Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9);
        const every = Math.ceil(decades.length / (1.5 * count)); // texts of decades are short
        return {values: decades.filter((unused, k) => k % every === 0), written: vkfv.decade};
    }

    // Places the texts from the last one backwards. The last one stays within the page; a text that would touch the one
    // behind it is removed.
    function placeTexts(axis, across, width) {
        const gap = 6;
        let next = width + gap;
        for (const text of axis.selectAll(".tick text").nodes().reverse()) {
            const half = vkfv.textWidth(text) / 2, place = across(d3.select(text).datum());
            const middle = Math.min(place, width - half);
            if (middle + half + gap > next) {
                text.remove();
            } else {
                d3.select(text).attr("dx", middle < place ? middle - place : null);
                next = middle - half;
            }
        }
    }

    function draw() {
        const given = content();
        element.selectAll("*").remove();
        if (!given) {
            return;
        }
        const {x, y, series, marks = [], height = 300} = given;
        const width = Math.max(240, element.node().clientWidth);
        const svg = element.append("svg").attr("role", "img").attr("aria-label", label);
        const right = width - margin.right;
        const title = svg.append("text").attr("x", 4).attr("y", 14).text(y.label);
        // Names of marks stand above the plot, where they cover neither curves nor axes.
        const lines = legend(svg, series, title, right) + (marks.some(mark => mark.name) ? 1 : 0);
        const top = 12 + lines * line, bottom = top + height - 30 - margin.bottom, whole = bottom + margin.bottom;
        svg.attr("viewBox", `0 0 ${width} ${whole}`).attr("width", width).attr("height", whole);
        const all = series.flatMap(one => one.points);
        const finite = k => all.map(point => point[k]).filter(Number.isFinite);
        const across = (x.log ? d3.scaleLog() : d3.scaleLinear()).domain(x.domain || d3.extent(finite(0))).range([margin.left, right]);
        const up = d3.scaleLinear().domain(y.domain || padded(d3.extent(y.zero ? [0, ...finite(1)] : finite(1)))).range([bottom, top]);
        const columns = axisTicks(across, x.log, Math.max(3, width / 90)), rows = axisTicks(up, false, Math.max(3, height / 60));
        svg.append("g").attr("class", "grid").attr("transform", `translate(${margin.left},0)`)
            .call(d3.axisLeft(up).tickValues(rows.values).tickSize(margin.left - right).tickFormat(""));
        svg.append("g").attr("transform", `translate(0,${bottom})`)
            .call(d3.axisBottom(across).tickValues(columns.values).tickFormat(columns.written))
            .call(placeTexts, across, width);
        svg.append("g").attr("transform", `translate(${margin.left},0)`)
            .call(d3.axisLeft(up).tickValues(rows.values).tickFormat(rows.written));
        svg.append("text").attr("x", (margin.left + right) / 2).attr("y", whole - 6).attr("text-anchor", "middle").text(x.label);
        const path = d3.line().defined(d => Number.isFinite(d[1])).x(d => across(d[0])).y(d => up(d[1]));
        const drawn = svg.append("g");
        series.forEach((one, k) => {
            const style = one.colour || k % styles + 1;
            drawn.append("path").attr("class", `series series-${style}`)
                .attr("d", path.curve(one.kind === "steps" ? d3.curveStep : d3.curveLinear)(one.points));
            if (one.dots) {
                drawn.append("g").attr("class", `dots-${style}`).selectAll("circle").data(one.points.filter(d => Number.isFinite(d[1])))
                    .enter().append("circle").attr("r", 2.5).attr("cx", d => across(d[0])).attr("cy", d => up(d[1]));
            }
        });
        for (const mark of marks) {
            const at = across(mark.x);
            drawn.append("line").attr("class", mark.quiet ? "mark-quiet" : "mark").attr("x1", at).attr("x2", at)
                .attr("y1", top).attr("y2", bottom);
            if (mark.name) {
                const name = drawn.append("text").attr("class", "mark-text").attr("y", top - 6).attr("text-anchor", "middle").text(mark.name);
                const half = vkfv.textWidth(name.node()) / 2;
                name.attr("x", Math.max(margin.left + half, Math.min(right - half, at)));
            }
        }
    }
    vkfv.events.on(`resize.${place}`, draw);
    return draw;
};
