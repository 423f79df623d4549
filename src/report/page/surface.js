"use strict";
// The surface in space, drawn by three.js, which starts when the surface is first seen.
vkfv.parts.push(() => {
    const canvas = document.getElementById("space");
    const note = d3.select("#space-note");
    const most = 256; // points along a side
    let space = null;

    const layer = () => d3.select("#space-layer").property("value");
    const chosenScale = () => 10 ** Number(d3.select("#space-scale").property("value"));

    // The surface has a vertex at each measured point, and a triangle between three such vertices.
    function geometry() {
        const {columns, rows, pitch, layers} = vkfv.chosen.evaluation.map;
        const heights = vkfv.heights(layers[layer()]);
        const step = Math.ceil(Math.max(columns, rows) / most);
        const [across, up] = [Math.floor((columns - 1) / step) + 1, Math.floor((rows - 1) / step) + 1];
        const [width, depth] = [(across - 1) * step * pitch[0], (up - 1) * step * pitch[1]];
        const unit = Math.max(width, depth) || 1;
        const positions = [], places = [], colours = [], faces = [];
        const {low, high} = vkfv.chosen.scale;
        const middle = (low + high) / 2;
        const palette = d3.scaleSequential(d3.interpolateViridis).domain([low, high]).clamp(true);
        for (let j = 0; j < up; ++j) {
            for (let i = 0; i < across; ++i) {
                const height = heights[j * step * columns + i * step];
                const {r, g, b} = d3.rgb(palette(Number.isFinite(height) ? height : low));
                positions.push((i * step * pitch[0] - width / 2) / unit, (j * step * pitch[1] - depth / 2) / unit,
                               Number.isFinite(height) ? (height - middle) / unit : 0);
                places.push((i * step + 0.5) / columns, (j * step + 0.5) / rows);
                colours.push(r / 255, g / 255, b / 255);
            }
        }
        const there = k => Number.isFinite(heights[Math.floor(k / across) * step * columns + k % across * step]);
        for (let j = 0; j + 1 < up; ++j) {
            for (let i = 0; i + 1 < across; ++i) {
                const k = j * across + i;
                for (const face of [[k, k + 1, k + across + 1], [k, k + across + 1, k + across]]) {
                    if (face.every(there)) {
                        faces.push(...face);
                    }
                }
            }
        }
        const result = new THREE.BufferGeometry();
        result.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
        result.setAttribute("uv", new THREE.Float32BufferAttribute(places, 2));
        result.setAttribute("color", new THREE.Float32BufferAttribute(colours, 3));
        result.setIndex(faces);
        note.text(faces.length ? "" : "Nothing was measured.");
        result.computeVertexNormals();
        space.relief = (high - low) / unit;
        return result;
    }

    function begin() {
        let renderer = null;
        try {
            renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
        } catch (failure) {
            note.text("This browser has no WebGL: the surface is not drawn in space.");
            return;
        }
        const scene = new THREE.Scene();
        const camera = new THREE.PerspectiveCamera(32, 1, 0.01, 50);
        camera.up.set(0, 0, 1);
        camera.position.set(-0.9, -1.5, 1.2);
        const controls = new THREE.OrbitControls(camera, canvas);
        controls.enableKeys = false; // keys would move the page's other parts too
        controls.enablePan = false;
        const light = new THREE.DirectionalLight(0xffffff, 0.65);
        light.position.set(-1, 0.6, 1.5);
        scene.add(light, new THREE.AmbientLight(0xffffff, 0.55));
        const material = new THREE.MeshLambertMaterial({side: THREE.DoubleSide});
        const mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
        scene.add(mesh);
        space = {renderer, scene, camera, controls, mesh, material, relief: 1, first: camera.position.clone()};
        controls.addEventListener("change", draw);
        listen();
        rebuild(true);
    }

    function texture(evaluation) {
        const image = new Image();
        const result = new THREE.Texture(image);
        result.minFilter = THREE.LinearFilter;
        result.generateMipmaps = false;
        image.onload = () => { result.needsUpdate = true; rebuild(false); };
        image.src = `data:image/png;base64,${vkfv.text(evaluation.map.texture)}`;
        return result;
    }

    function rebuild(anew) {
        if (!space) {
            return;
        }
        space.mesh.geometry.dispose();
        space.mesh.geometry = geometry();
        if (anew || space.of !== vkfv.chosen.evaluation) {
            space.of = vkfv.chosen.evaluation;
            space.texture = texture(space.of);
            // A height of a fifth of the width shows any relief.
            const factor = Math.log10(Math.max(0.1, Math.min(1000, 0.2 / Math.max(1e-9, space.relief))));
            d3.select("#space-scale").property("value", Math.round(factor * 20) / 20);
        }
        // The surface has the heights' colours until the image is there.
        const textured = d3.select("#space-colour").property("value") === "texture" && space.texture.image.complete;
        space.material.map = textured ? space.texture : null;
        space.material.vertexColors = textured ? THREE.NoColors : THREE.VertexColors;
        space.material.needsUpdate = true;
        draw();
    }

    function draw() {
        if (window.matchMedia("print").matches) {
            return; // the print shows the picture of the window
        }
        const width = canvas.clientWidth, height = canvas.clientHeight;
        space.scene.background = new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue("--raised").trim());
        space.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
        space.renderer.setSize(width, height, false);
        space.camera.aspect = width / Math.max(1, height);
        space.camera.updateProjectionMatrix();
        space.mesh.scale.z = chosenScale();
        d3.select("#space-scale-text").text(vkfv.number(chosenScale(), 2));
        space.renderer.render(space.scene, space.camera);
    }

    // Turns the camera by angles (radians) around the vertical and above the plane, and multiplies its distance by a
    // factor.
    function turn(around, above, factor = 1) {
        const {camera, controls} = space;
        const place = new THREE.Spherical().setFromVector3(
            new THREE.Vector3(camera.position.x, camera.position.z, -camera.position.y));
        place.theta += around;
        place.phi = Math.max(0.05, Math.min(Math.PI - 0.05, place.phi - above));
        place.radius = Math.max(0.2, Math.min(20, place.radius * factor));
        const to = new THREE.Vector3().setFromSpherical(place);
        camera.position.set(to.x, -to.z, to.y);
        controls.update();
        draw();
    }

    function listen() {
        canvas.addEventListener("keydown", event => {
            const turns = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1],
                           "+": [0, 0, 0.9], "=": [0, 0, 0.9], "-": [0, 0, 1 / 0.9]};
            if (turns[event.key]) {
                turn(...turns[event.key]);
                event.preventDefault();
            }
        });
        d3.select("#space-reset").on("click", () => { space.camera.position.copy(space.first); space.controls.update(); draw(); });
        d3.select("#space-scale").on("input", draw);
        d3.selectAll("#space-colour, #space-layer").on("change", () => rebuild(false));
        vkfv.events.on("scale.space", () => rebuild(false));
        vkfv.events.on("resize.space", draw);
        window.matchMedia("(prefers-color-scheme: dark)").addListener(draw);
    }

    d3.select("#space-layer").selectAll("option")
        .data([["measured", "measured"], ["truth", "true"]].filter(d => vkfv.data.evaluations[0].map.layers[d[0]]))
        .enter().append("option").attr("value", d => d[0]).text(d => d[1]);
    const begun = () => { if (!space) { begin(); } };
    new IntersectionObserver((seen, observer) => {
        if (seen.some(one => one.isIntersecting)) {
            observer.disconnect();
            begun();
        }
    }, {rootMargin: "200px"}).observe(canvas);
    window.addEventListener("beforeprint", () => {
        begun();
        if (space) { // a canvas out of sight might be printed as last shown
            draw();
            document.getElementById("space-print").src = canvas.toDataURL();
        }
    });
});
