"use strict";
// The base that all parts of the page share: data, choices and the notation of numbers. Lengths are micrometres.
const vkfv = (() => {
    const text = id => document.getElementById(id).textContent;
    const data = JSON.parse(text("data"));

    // The base64 of a script element as an array of this type, which is decoded once.
    const decoded = new Map();
    function blob(id, Type) {
        if (!decoded.has(id)) {
            const letters = atob(text(id));
            const bytes = new Uint8Array(letters.length);
            for (let k = 0; k < letters.length; ++k) {
                bytes[k] = letters.charCodeAt(k);
            }
            decoded.set(id, new Type(bytes.buffer));
        }
        return decoded.get(id);
    }

    // Numbers as src/report/reader_text writes them: four significant digits, a true minus, powers of ten beyond 10⁻⁴ and 10⁵.
    const exponentOf = (value, digits) => value === 0 ? 0 : Number(value.toExponential(digits - 1).split("e")[1]);
    const powerOf = exponent => exponent < -4 || exponent > 5 ? exponent : 0;
    const raised = power => [...String(power)].map(c => c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]).join("");
    const times = power => power ? `\u00a0×\u00a010${raised(power)}` : "";

    // The digits of a number alone. A negative number of decimals makes the last digits before the point zeros.
    function fixed(value, {power, decimals}) {
        const shown = value / 10 ** power, unit = 10 ** -decimals;
        const text = decimals < 0 ? String(Math.round(shown / unit) * unit) : shown.toFixed(decimals);
        return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
    }

    // The common notation of numbers that are compared: all have the decimals of the largest.
    function form(values, digits = 4) {
        const exponent = exponentOf(d3.max(values.filter(Number.isFinite), Math.abs) || 0, digits);
        const power = powerOf(exponent);
        return {power, decimals: digits - 1 - exponent + power};
    }
    const alike = (value, how) => Number.isFinite(value) ? fixed(value, how) + times(how.power) : "–";

    // A measured number keeps its zeros at the end; numbers that were set, and ticks, do not need them.
    const figure = (value, digits = 4) => value === 0 ? "0" : alike(value, form([value], digits));
    function number(value, digits = 4) {
        if (!Number.isFinite(value)) {
            return "–";
        }
        const how = form([value], digits);
        const text = fixed(value, how);
        return (text.includes(".") ? text.replace(/\.?0+$/, "") : text) + times(how.power);
    }

    // A value with its standard uncertainty if this is known: two digits of the uncertainty, and the value to the same
    // decimals.
    function uncertain(value, uncertainty) {
        const most = 6; // digits of the value
        if (!Number.isFinite(value) || !(uncertainty > 0) || !Number.isFinite(uncertainty)) {
            return figure(value);
        }
        const last = exponentOf(uncertainty, 2) - 1;
        if (exponentOf(value, 4) - last >= most) {
            return `${figure(value)} ± ${figure(uncertainty, 2)}`;
        }
        const power = powerOf(exponentOf(Math.max(Math.abs(value), uncertainty), 4));
        const both = [value, uncertainty].map(one => fixed(one, {power, decimals: power - last})).join(" ± ");
        return power ? `(${both})${times(power)}` : both;
    }

    // Ticks of an axis in one notation, with no more decimals than they need.
    function ticks(values) {
        const {power, decimals} = form(values);
        const whole = (value, k) => Math.abs(value / 10 ** power * 10 ** k - Math.round(value / 10 ** power * 10 ** k)) < 1e-6;
        const least = d3.range(decimals).find(k => values.every(value => whole(value, k)));
        return value => value === 0 ? "0" : alike(value, {power, decimals: least === undefined ? decimals : least});
    }
    // A power of ten. The first two are written in full.
    const decade = value => [1, 10].includes(value) ? String(value) : `10${raised(Math.round(Math.log10(value)))}`;

    const states = ["measured", "no peak within the scan", "no better than chance", "poor fit", "many peaks",
                    "repaired from its neighbours", "low contrast", "dark"];

    // Heights of a layer of a map in µm, NaN where nothing was measured; row 0 has the lowest y.
    const layers = new Map();
    function heights(layer) {
        if (!layers.has(layer)) {
            const packed = blob(layer.blob, Uint16Array);
            const step = (layer.high - layer.low) / 65534;
            const values = new Float32Array(packed.length);
            for (let k = 0; k < packed.length; ++k) {
                values[k] = packed[k] === 65535 ? NaN : layer.low + step * packed[k];
            }
            layers.set(layer, values);
        }
        return layers.get(layer);
    }

    // The choices, and the events that tell of a change: "cursor", "view", "profile", "evaluation", "scale", "frame".
    const chosen = {evaluation: (data.evaluations || [])[0], cursor: null, profile: null, frame: 0, scale: null};
    const events = d3.dispatch("cursor", "view", "profile", "evaluation", "scale", "frame", "resize");
    function choose(what, value) {
        chosen[what] = value;
        events.call(what);
    }

    const parts = []; // main.js runs them when all are there
    return {data, text, blob, number, figure, form, alike, uncertain, ticks, decade, states, heights, chosen, events, choose, parts};
})();
