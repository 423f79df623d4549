"use strict";
// The histogram of heights, and the share of the area on which each height is exceeded.
vkfv.parts.push(() => {
    const of = (name, key) => vkfv.chosen.evaluation.distributions[key] &&
        {name, ...vkfv.chosen.evaluation.distributions[key]};
    const both = () => [of("measured", "measured"), of("true", "truth")].filter(Boolean);

    const histogram = vkfv.chart("#histogram", "Histogram of heights", () => {
        if (!vkfv.chosen.evaluation.distributions) {
            return null;
        }
        const {low, high} = vkfv.chosen.evaluation.distributions;
        return {x: {label: "height / µm", domain: [low, high]}, y: {label: "share of the points / %", zero: true},
                series: both().map(({name, shares}) => ({name, kind: "steps",
                    points: shares.map((share, k) => [low + (k + 0.5) * (high - low) / shares.length, 100 * share])}))};
    });
    const abbott = vkfv.chart("#abbott", "Height over the share of the area that stands higher", () => vkfv.chosen.evaluation.distributions && ({
        x: {label: "material ratio / %", domain: [0, 100]}, y: {label: "height / µm"},
        series: both().map(({name, heights}) => ({name, points: heights.map((height, k) => [k, height])}))}));

    vkfv.events.on("evaluation.distributions", () => {
        histogram();
        abbott();
    });
});
