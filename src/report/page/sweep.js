"use strict";
// A sweep as a matrix: the first parameter down and the last along, with choices for those between above it. A click, or Enter,
// shows a combination. The chart of the figure over the last parameter stands below.
vkfv.parts.push(() => {
    const {parameters, rows, figures} = vkfv.data;
    const {figure} = vkfv;
    const most = 100; // largest ratio of swept values on a linear axis
    const last = parameters.length - 1;
    const down = last > 0 ? parameters[0] : {label: "", values: [""]};
    const between = parameters.slice(1, -1);
    const chosen = {figure: figures[0], between: between.map(one => one.values[0]), row: rows[0]};
    const written = value => typeof value === "number" ? figure(value) : value === null || value === undefined ? "–" : String(value);
    const named = name => name.replace(/\bum\b/, "µm");
    const valueOf = (k, value) => parameters[k].written[parameters[k].values.indexOf(value)];
    const titleOf = row => parameters.map(({label}, k) => `${label} = ${valueOf(k, row.values[k])}`).join(", ");
    const picture = row => `data:image/png;base64,${vkfv.text(row.picture)}`;
    const fits = row => chosen.between.every((value, k) => row.values[k + 1] === value);

    function show(row) {
        chosen.row = row;
        d3.selectAll("#sweep-matrix button").attr("aria-pressed", d => String(d === row));
        d3.select("#sweep-image").attr("src", picture(row)).attr("alt", `Picture of ${titleOf(row)}`);
        d3.select("#sweep-text").text(`${titleOf(row)}: ${named(chosen.figure)} ${written(row.figures[chosen.figure])}`);
        const place = d3.select("#sweep-figures").html("");
        const table = place.append("table");
        table.append("caption").text(titleOf(row));
        table.selectAll("tr").data(Object.entries(row.figures)).enter().append("tr").each(function ([name, value]) {
            d3.select(this).append("th").attr("scope", "row").text(named(name));
            d3.select(this).append("td").text(written(value));
        });
        for (const [path, title] of row.links) {
            place.append("p").append("a").attr("href", path.split("/").map(encodeURIComponent).join("/")).text(title);
        }
    }

    function draw() {
        const there = rows.filter(fits);
        const values = there.map(row => row.figures[chosen.figure]).filter(Number.isFinite);
        const share = d3.scaleLinear().domain(d3.extent(values)).range([0, 100]);
        const table = d3.select("#sweep-matrix").html("");
        table.append("caption").text(`${named(chosen.figure)}: ${down.label ? `${down.label} down, ` : ""}${parameters[last].label} along; the bar runs from the least to the largest`);
        const head = table.append("tr");
        head.append(down.label ? "th" : "td").attr("scope", down.label ? "col" : null).text(down.label);
        head.selectAll(null).data(parameters[last].values).enter().append("th").attr("scope", "col").text(d => valueOf(last, d));
        for (const value of down.values) {
            const line = table.append("tr");
            line.append(value ? "th" : "td").attr("scope", value ? "row" : null).text(down.label ? valueOf(0, value) : "");
            for (const along of parameters[last].values) {
                const row = there.find(one => one.values[last] === along && (last === 0 || one.values[0] === value));
                const cell = line.append("td").append("button").attr("type", "button").attr("class", "cell").datum(row)
                    .attr("aria-label", `${titleOf(row)}: ${written(row.figures[chosen.figure])}`).on("click", () => show(row));
                cell.append("img").attr("src", picture(row)).attr("alt", "");
                cell.append("span").text(written(row.figures[chosen.figure]));
                cell.append("span").attr("class", "bar").style("width", `${share(row.figures[chosen.figure]) || 0}%`);
            }
        }
        show(fits(chosen.row) ? chosen.row : there[0]);
        chart();
    }

    // A curve for each value of the first parameter. There is no chart unless the last parameter is a number.
    const chart = vkfv.chart("#sweep-chart", "The figure over the last parameter", () => {
        const along = parameters[last].values.map(Number);
        if (!along.every(Number.isFinite) || along.length < 2) {
            return null;
        }
        const series = down.values.map(value => ({
            name: down.label ? `${down.label} = ${valueOf(0, value)}` : "", dots: true,
            points: rows.filter(row => fits(row) && (last === 0 || row.values[0] === value))
                .map(row => [Number(row.values[last]), row.figures[chosen.figure]]).sort((a, b) => a[0] - b[0])}));
        const [least, largest] = d3.extent(along);
        return {x: {label: parameters[last].label, log: least > 0 && largest > most * least}, y: {label: named(chosen.figure)}, series};
    });

    const choice = (place, values, change, shown = d => d) => place.on("change", function () { change(values[this.selectedIndex]); draw(); })
        .selectAll("option").data(values).enter().append("option").text(shown);
    choice(d3.select("#sweep-figure"), figures, value => { chosen.figure = value; }, named);
    between.forEach((parameter, k) => {
        const label = d3.select("#sweep-choices").append("label").text(`${parameter.label} `);
        choice(label.append("select"), parameter.values, value => { chosen.between[k] = value; }, value => valueOf(k + 1, value));
    });
    draw();
});
