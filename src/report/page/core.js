"use strict";
// What all parts of the page share: the data, what is chosen, and how numbers are written. Lengths are micrometres.
const vkfv = (() => {
    const text = id => document.getElementById(id).textContent;
    const data = JSON.parse(text("data"));

    // Base64 of a script element as an array of this type; decoded once.
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

    // At most four significant digits, as the tables have them.
    function number(value, digits = 4) {
        if (!Number.isFinite(value)) {
            return "–";
        }
        if (value === 0) {
            return "0";
        }
        const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
        const short = String(Number(mantissa));
        const power = Number(exponent);
        const written = power < -4 || power > 5
            ? `${short} × 10${[...String(power)].map(c => c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]).join("")}`
            : String(Number(value.toPrecision(digits)));
        return written.replace("-", "−");
    }

    // With its standard uncertainty, if that is known: two digits of it, and no more than four of the value.
    function uncertain(value, uncertainty) {
        if (!Number.isFinite(value) || !(uncertainty > 0) || !Number.isFinite(uncertainty)) {
            return number(value);
        }
        const decimals = Math.max(0, Math.min(1 - Math.floor(Math.log10(uncertainty)),
                                              3 - Math.floor(Math.log10(Math.max(Math.abs(value), 1e-3)))));
        const error = uncertainty.toFixed(decimals);
        return `${value.toFixed(decimals).replace("-", "−")} ± ${Number(error) > 0 ? error : number(uncertainty, 1)}`;
    }

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

    // What is chosen, and who wants to know: "cursor", "view", "profile", "evaluation", "scale", "frame".
    const chosen = {evaluation: (data.evaluations || [])[0], cursor: null, profile: null, frame: 0, scale: null};
    const events = d3.dispatch("cursor", "view", "profile", "evaluation", "scale", "frame", "resize");
    function choose(what, value) {
        chosen[what] = value;
        events.call(what);
    }

    const parts = []; // run by main.js once all are there
    return {data, text, blob, number, uncertain, states, heights, chosen, events, choose, parts};
})();
