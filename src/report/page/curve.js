"use strict";
// The focus curve of the grid's point nearest to the cursor, with the fit that found its peak.
vkfv.parts.push(() => {
    const {number} = vkfv;
    const numbers = 10; // for each curve: see curves_data() of page_data.cpp

    // Returns {z: [...], values: [...], peak, uncertainty, fit: [[z, value] ...], column, row}, or null without curves. The pixel of the
    // image has its column counted from the left and its row from below.
    vkfv.curve = () => {
        const {curves, pixels} = vkfv.chosen.evaluation;
        if (!curves) {
            return null;
        }
        const {x, y} = vkfv.chosen.cursor;
        const of = (value, origin, step, count, kept) => {
            const pixel = Math.max(0, Math.min(count - 1, Math.round((value - origin) / step)));
            return Math.floor((pixel + 0.5) * kept / count);
        };
        const column = of(x, pixels.x0, pixels.pitch[0], pixels.columns, curves.columns.length);
        const row = of(y, pixels.y0, pixels.pitch[1], pixels.rows, curves.rows.length);
        const point = row * curves.columns.length + column;
        const z = curves.z.filter((unused, k) => k % curves.every === 0);
        const [low, high, peak, uncertainty, at, range, largest, c0, c1, c2] =
            vkfv.blob(curves.fits, Float32Array).subarray(numbers * point, numbers * (point + 1));
        const bytes = vkfv.blob(curves.values, Uint8Array).subarray(point * z.length, (point + 1) * z.length);
        const values = Array.from(bytes, byte => low + byte / 255 * (high - low));
        const fit = [];
        if (range > 0) {
            const reach = Math.max(range, 2.5);
            const place = d3.scaleLinear().domain(d3.range(curves.z.length)).range(curves.z);
            for (let step = -reach; step <= reach + 1e-9; step += reach / 40) {
                const exponent = c0 + c1 * step + c2 * step * step;
                if (at + step >= 0 && at + step <= curves.z.length - 1) {
                    fit.push([place(at + step), largest * (curves.gaussian ? Math.exp(exponent) : 1 + exponent)]);
                }
            }
        }
        return {z, values, peak, uncertainty, fit: fit.filter(d => d[1] >= 0), column: curves.columns[column], row: curves.rows[row]};
    };

    const draw = vkfv.chart("#curve", "Focus measure over the height of the focal plane", () => {
        const curve = vkfv.curve();
        if (!curve) {
            return null;
        }
        const {frames} = vkfv.data;
        const marks = [];
        if (Number.isFinite(curve.peak)) {
            marks.push({x: curve.peak, name: `peak ${vkfv.uncertain(curve.peak, curve.uncertainty)} µm`});
        }
        if (frames.z.length) {
            marks.push({x: frames.z[vkfv.chosen.frame], quiet: true});
        }
        const extent = d3.extent([...curve.z, ...frames.z]);
        return {x: {label: "z / µm", domain: extent}, y: {label: "focus measure", zero: true}, height: 340, marks,
                series: [{name: "curve", dots: true, points: d3.zip(curve.z, curve.values)}, {name: "fit", points: curve.fit}]};
    });

    function show() {
        const curve = vkfv.curve();
        if (!curve) {
            return;
        }
        draw();
        const {pixels, curves} = vkfv.chosen.evaluation;
        const {x0, y0, pitch} = pixels;
        d3.select("#curve-text").text(
            `Pixel at x ${number(x0 + curve.column * pitch[0])} µm, y ${number(y0 + curve.row * pitch[1])} µm: ` +
            `${vkfv.chosen.cursor.state}; ` +
            (Number.isFinite(curve.peak) ? `peak at z = ${vkfv.uncertain(curve.peak, curve.uncertainty)} µm (${curves.method})` : "no peak"));
    }
    vkfv.events.on("cursor.curve", show);
    vkfv.events.on("frame.curve", show);
});
