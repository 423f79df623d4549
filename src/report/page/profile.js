"use strict";
// The profile along a line over the maps: the values of the nearest points, one for each pitch.
vkfv.parts.push(() => {
    const {number} = vkfv;
    const names = {measured: "measured", truth: "true", deviation: "deviation"};

    // Returns {distance, measured: [...], truth, deviation} in µm.
    vkfv.profile = () => {
        const {from, to} = vkfv.chosen.profile;
        const {columns, pitch, layers} = vkfv.chosen.evaluation.map;
        const length = Math.hypot(to.x - from.x, to.y - from.y);
        const steps = Math.max(1, Math.max(Math.abs(to.column - from.column), Math.abs(to.row - from.row)));
        const result = {distance: [], columns: [], rows: []};
        for (let k = 0; k <= steps; ++k) {
            const share = k / steps;
            result.distance.push(share * length);
            result.columns.push(Math.round(from.column + share * (to.column - from.column)));
            result.rows.push(Math.round(from.row + share * (to.row - from.row)));
        }
        for (const [name, layer] of Object.entries(layers)) {
            const heights = vkfv.heights(layer);
            result[name] = result.columns.map((column, k) => heights[result.rows[k] * columns + column]);
        }
        return result;
    };

    const series = wanted => {
        const profile = vkfv.profile();
        return wanted.filter(name => profile[name]).map(name => ({name: names[name], points: d3.zip(profile.distance, profile[name])}));
    };
    const heights = vkfv.chart("#profile-heights", "Heights along the profile", () => ({
        x: {label: "distance / µm"}, y: {label: "height / µm"}, series: series(["measured", "truth"])}));
    const deviation = vkfv.chart("#profile-deviation", "Deviation along the profile", () => vkfv.chosen.evaluation.map.layers.deviation && ({
        x: {label: "distance / µm"}, y: {label: "deviation / µm", zero: true}, height: 190,
        series: series(["deviation"]).map(one => ({...one, colour: 3}))}));

    vkfv.events.on("profile.chart", () => {
        heights();
        deviation();
        const {from, to} = vkfv.chosen.profile;
        const profile = vkfv.profile();
        const measured = profile.measured.filter(Number.isFinite);
        const deviations = (profile.deviation || []).filter(Number.isFinite);
        const how = vkfv.form(d3.extent(measured));
        d3.select("#profile-text").text(
            `From (${number(from.x)}, ${number(from.y)}) to (${number(to.x)}, ${number(to.y)}) µm, ${profile.distance.length} points: measured ` +
            (measured.length ? `${vkfv.alike(d3.min(measured), how)} to ${vkfv.alike(d3.max(measured), how)} µm` : "nothing") +
            (deviations.length ? `, RMS deviation ${vkfv.alike(Math.sqrt(d3.mean(deviations, d => d * d)), how)} µm` : ""));
    });
});
