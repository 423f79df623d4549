"use strict";
// Curves over two axes, as wide as their place and drawn again when that changes.
// content(): {x: {label, domain}, y: {label, domain, zero}, series: [{name, points: [[x, y] ...], kind}], marks: [{x, name,
// quiet}], height, dots}; y of NaN leaves a gap; null: there is nothing to draw. kind: "line" (default), "steps", "plain" (a line without a legend).
vkfv.chart = (place, label, content) => {
    const element = d3.select(place);
    const margin = {top: 30, right: 16, bottom: 44, left: 62};

    function padded([low, high]) {
        const pad = high > low ? 0.04 * (high - low) : Math.abs(low) * 0.05 || 1;
        return [low - pad, high + pad];
    }

    function draw() {
        const given = content();
        if (!given) {
            element.selectAll("*").remove();
            return;
        }
        const {x, y, series, marks = [], height = 300, dots = false} = given;
        const width = Math.max(240, element.node().clientWidth);
        element.selectAll("*").remove();
        const svg = element.append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("width", width)
            .attr("height", height).attr("role", "img").attr("aria-label", label);
        const all = series.flatMap(one => one.points);
        const finite = k => all.map(point => point[k]).filter(Number.isFinite);
        const right = width - margin.right, bottom = height - margin.bottom;
        const across = d3.scaleLinear().domain(x.domain || d3.extent(finite(0))).range([margin.left, right]);
        const up = d3.scaleLinear().domain(y.domain || padded(d3.extent(y.zero ? [0, ...finite(1)] : finite(1))))
            .range([bottom, margin.top]);
        const written = d => vkfv.number(d);
        const columns = Math.max(3, width / 90), lines = Math.max(3, height / 60);
        svg.append("g").attr("class", "grid").attr("transform", `translate(${margin.left},0)`)
            .call(d3.axisLeft(up).ticks(lines).tickSize(margin.left - right).tickFormat(""));
        svg.append("g").attr("transform", `translate(0,${bottom})`)
            .call(d3.axisBottom(across).ticks(columns).tickFormat(written));
        svg.append("g").attr("transform", `translate(${margin.left},0)`)
            .call(d3.axisLeft(up).ticks(lines).tickFormat(written));
        svg.append("text").attr("x", (margin.left + right) / 2).attr("y", height - 6).attr("text-anchor", "middle").text(x.label);
        svg.append("text").attr("x", 4).attr("y", 14).text(y.label);
        const line = d3.line().defined(d => Number.isFinite(d[1])).x(d => across(d[0])).y(d => up(d[1]));
        const steps = d3.line().defined(d => Number.isFinite(d[1])).x(d => across(d[0])).y(d => up(d[1])).curve(d3.curveStep);
        const drawn = svg.append("g");
        series.forEach((one, k) => {
            drawn.append("path").attr("class", `series series-${one.colour || k + 1}`)
                .attr("d", (one.kind === "steps" ? steps : line)(one.points));
            if (dots && k === 0) {
                drawn.selectAll("circle").data(one.points).enter().append("circle").attr("class", "dots-1")
                    .attr("r", 2.5).attr("cx", d => across(d[0])).attr("cy", d => up(d[1]));
            }
        });
        for (const mark of marks) {
            drawn.append("line").attr("class", mark.quiet ? "mark-quiet" : "mark").attr("x1", across(mark.x))
                .attr("x2", across(mark.x)).attr("y1", margin.top).attr("y2", bottom);
            if (mark.name) {
                const left = across(mark.x) > (margin.left + right) / 2;
                drawn.append("text").attr("class", "mark-text").attr("x", across(mark.x) + (left ? -6 : 6))
                    .attr("y", bottom - 8).attr("text-anchor", left ? "end" : "start").text(mark.name);
            }
        }
        // The legend, from the right.
        let end = right;
        for (let k = series.length - 1; k >= 0; --k) {
            if (series[k].kind === "plain" || !series[k].name) {
                continue;
            }
            const name = svg.append("text").attr("y", 14).text(series[k].name);
            end -= name.node().getComputedTextLength();
            name.attr("x", end);
            svg.append("line").attr("class", `series series-${series[k].colour || k + 1}`).attr("x1", end - 30)
                .attr("x2", end - 6).attr("y1", 10).attr("y2", 10);
            end -= 44;
        }
    }
    vkfv.events.on(`resize.${place}`, draw);
    return draw;
};
