"use strict";
// The times of a run, from the file timings.js beside the page. The page itself has no times, so that it is the same
// bytes after each run.
vkfv.timings = {
    show(csv) {
        const {figure} = vkfv;
        const rows = d3.csvParse(csv, row => ({what: row.what, seconds: Number(row.seconds), rays: Number(row.rays_per_s)}));
        const images = rows.filter(row => /^image \d+$/.test(row.what))
            .map(row => [Number(row.what.slice(6)), row.seconds]).sort((a, b) => a[0] - b[0]);
        d3.select("#timings-text").text(images.length
            ? `${images.length} exposures took ${figure(d3.sum(images, d => d[1]))} s together, ${figure(d3.median(images, d => d[1]))} s in the median.` : "");
        if (images.length > 1) {
            vkfv.chart("#timings-chart", "Time of each exposure", () => ({x: {label: "image"}, y: {label: "time / s", zero: true}, height: 220,
                series: [{name: "exposure", points: images}]}))();
        }
        const table = d3.select("#timings-table").html("").append("table");
        table.append("caption").text("Everything else");
        table.selectAll("tr").data(rows.filter(row => !/^image \d+$/.test(row.what))).enter().append("tr")
            .each(function (row) {
                d3.select(this).append("th").attr("scope", "row").text(row.what);
                d3.select(this).append("td").text(`${figure(row.seconds)} s`);
            });
        d3.select("#timings-load").attr("hidden", "hidden");
    },
};
vkfv.parts.push(() => {
    d3.select("#timings-load").on("click", () => {
        const script = document.createElement("script");
        script.src = "timings.js";
        script.onerror = () => d3.select("#timings-text").text("There is no timings.js beside this page.");
        document.head.append(script);
    });
});
