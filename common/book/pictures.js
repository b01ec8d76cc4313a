// Pictures to hold: two beside each other behind a slider, the values of a pixel, exposure, the error
// and single pixels.

const make = (tag, attributes = {}, ...children) => {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (typeof value === 'function') node[name] = value;
        else if (value !== false) node.setAttribute(name, value === true ? '' : value);
    }
    node.append(...children);
    return node;
};
const digits = x => Number.isFinite(x) ? x.toPrecision(3) : 'not finite';

// 8-bit sRGB to linear radiance, and back for many values between 0 and 1.
const fromSrgb = Float32Array.from({length: 256}, (_, code) => {
    const s = code / 255;
    return s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4;
});
const steps = 4095;
const toSrgb = Uint8ClampedArray.from({length: steps + 1}, (_, i) => {
    const x = i / steps;
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
});

/// A canvas with what is needed to look closely. pictures: {name, width, height, pixels}, linear, four
/// numbers a pixel; all of one size. The first is to the left of the slider, the second to the right.
class Viewer {
    constructor() {
        this.left = 0, this.right = 1, this.exposure = 0, this.zoom = 1, this.error = false;
        this.slider = 0.5, this.pictures = [];
        this.canvas = make('canvas', {tabindex: 0, role: 'img', width: 256, height: 256});
        this.overlay = make('div', {class: 'overlay'});
        this.mark = make('div', {class: 'mark', hidden: true});  // around the pixel that keys have chosen
        this.pick = null;  // called with the pixel that is clicked, or chosen by keys and Enter
        this.stage = make('div', {class: 'stage'},
            make('div', {class: 'sheet'}, this.canvas, this.overlay, this.mark));
        this.choices = make('span', {class: 'choices', role: 'group', 'aria-label': 'picture'});
        this.readout = make('output', {class: 'readout'}, 'point at a pixel to read its values, or move by the arrow keys');
        this.range = make('input', {
            type: 'range', min: 0, max: 1, step: 0.005, value: 0.5, hidden: true,
            'aria-label': 'slider between two pictures',
            oninput: () => { this.slider = +this.range.value; this.draw(); }
        });
        this.buttons = make('span', {class: 'buttons'}, ...[
            ['e', 'darker', () => this.expose(-0.5)], ['E', 'brighter', () => this.expose(0.5)],
            ['d', 'error view', () => this.toggleError()], ['z', 'zoom', () => this.magnify()]
        ].map(([key, name, act]) => make('button', {type: 'button', title: `key ${key}`, onclick: act}, name)));
        this.node = make('div', {class: 'viewer', hidden: true}, this.stage, this.range, this.choices, this.buttons, this.readout);
        this.canvas.onpointermove = event => this.read(this.pixelAt(event));
        this.canvas.onpointerdown = event => this.read(this.pixelAt(event));
        this.canvas.onclick = event => this.pick?.(this.pixelAt(event));
        this.canvas.onblur = () => { this.mark.hidden = true; };
        this.node.onkeydown = event => this.press(event);
    }

    set(pictures) {
        this.pictures = pictures, this.node.hidden = false;
        if (pictures.length !== this.count) this.left = 0, this.right = Math.min(1, pictures.length - 1);
        this.count = pictures.length;
        const {width, height} = pictures[0];
        if (this.canvas.width !== width || this.canvas.height !== height) {
            this.canvas.width = width, this.canvas.height = height;
        }
        this.range.hidden = pictures.length < 2;
        const names = pictures.map(picture => picture.name).join('|');
        if (names !== this.names) this.offer(names);
        this.draw();
    }
    /// Buttons for the pictures: the one to the left of the slider, and the one to its right.
    offer(names) {
        this.names = names;
        this.choices.replaceChildren(...this.pictures.length < 2 ? [] : this.pictures.map((picture, i) =>
            make('button', {type: 'button', title: `key ${i + 1}`, onclick: () => this.show(i)},
                `${i + 1} ${picture.name}`)));
    }
    /// Shows a picture to the right of the slider, and what was there to its left.
    show(i) {
        if (i >= this.pictures.length || i === this.right) return;
        this.left = this.right, this.right = i;
        this.draw();
    }
    expose(stops) { this.exposure += stops; this.draw(); }
    toggleError() { this.error = !this.error; this.draw(); }
    magnify() {
        this.zoom = this.zoom >= 8 ? 1 : 2 * this.zoom;
        this.stage.classList.toggle('zoomed', this.zoom > 1);
        this.canvas.parentNode.style.width = this.zoom > 1 ? `${100 * this.zoom}%` : '';
    }
    press(event) {
        const act = {
            e: () => this.expose(-0.5), E: () => this.expose(0.5), d: () => this.toggleError(),
            z: () => this.magnify(),
            ...event.target === this.canvas && {
                ArrowLeft: () => this.move(-1, 0, event), ArrowRight: () => this.move(1, 0, event),
                ArrowUp: () => this.move(0, -1, event), ArrowDown: () => this.move(0, 1, event),
                Enter: () => this.at && this.pick?.(this.at)
            }
        }[event.key] || (/^[1-9]$/.test(event.key) && (() => this.show(event.key - 1)));
        if (!act || event.target.closest('input:not([type=range]), textarea, select')) return;
        act();
        event.preventDefault();
    }

    /// Moves the mark by one pixel, with Shift by ten, and reads the pixel that it is around.
    move(dx, dy, event) {
        const {width, height} = this.canvas, step = event.shiftKey ? 10 : 1;
        const [x, y] = this.at || [width >> 1, height >> 1], inside = (v, n) => Math.min(n - 1, Math.max(0, v));
        this.at = this.at && this.at[0] < width && this.at[1] < height ?
            [inside(x + step * dx, width), inside(y + step * dy, height)] : [width >> 1, height >> 1];
        this.mark.hidden = false;
        this.mark.style.left = `${100 * (this.at[0] + 0.5) / width}%`;
        this.mark.style.top = `${100 * (this.at[1] + 0.5) / height}%`;
        this.read(this.at);
    }

    draw() {
        if (this.pictures.length === 0) return;
        const {width, height} = this.pictures[0], image = new ImageData(width, height);
        const a = this.pictures[this.left], b = this.pictures[this.right], gain = steps * 2 ** this.exposure;
        const edge = a === b ? width : Math.round(this.slider * width);
        for (let i = 0; i < image.data.length; i += 4) {
            const from = i / 4 % width < edge ? a : b;
            for (let k = 0; k < 3; k++) {
                const value = this.error ? this.errorAt(a, b, i) : from.pixels[i + k];
                image.data[i + k] = toSrgb[Math.min(steps, Math.max(0, gain * value | 0))];
            }
            image.data[i + 3] = 255;
        }
        const paint = this.canvas.getContext('2d');
        paint.putImageData(image, 0, 0);
        if (!this.error && edge > 0 && edge < width) {
            paint.fillStyle = '#f80';
            paint.fillRect(edge, 0, Math.max(1, width / 256), height);
        }
        this.canvas.setAttribute('aria-label', this.error ? `how far ${a.name} is from ${b.name}` :
            a === b ? a.name : `${a.name} to the left, ${b.name} to the right`);
        [...this.choices.children].forEach((button, i) => {
            button.setAttribute('aria-pressed', i === this.left || i === this.right);
        });
        for (const button of this.buttons.children) {
            if (button.title === 'key d') button.setAttribute('aria-pressed', this.error);
        }
    }
    /// |a - b| / (b + 0.1) of the pixel, in grey.
    errorAt(a, b, i) {
        let difference = 0, size = 0;
        for (let k = 0; k < 3; k++) {
            difference += Math.abs(a.pixels[i + k] - b.pixels[i + k]), size += b.pixels[i + k];
        }
        return difference / (size + 0.1);
    }

    pixelAt(event) {
        const box = this.canvas.getBoundingClientRect(), {width, height} = this.canvas;
        const x = Math.floor((event.clientX - box.left) / box.width * width);
        const y = Math.floor((event.clientY - box.top) / box.height * height);
        return [Math.min(width - 1, Math.max(0, x)), Math.min(height - 1, Math.max(0, y))];
    }
    read([x, y]) {
        if (this.pictures.length === 0) return;
        const i = 4 * (y * this.canvas.width + x);
        const a = this.pictures[this.left], b = this.pictures[this.right];
        const values = p => [...p.pixels.subarray(i, i + 3)];
        const said = p => `${p.name} (${values(p).map(digits).join(', ')})`;
        let text = `pixel ${x},${y}: ${said(a)}`;
        if (a !== b) {
            const apart = values(a).map((value, k) => value - values(b)[k]);
            const error = apart.reduce((sum, d, k) => sum + d * d / (values(b)[k] ** 2 + 0.01), 0) / 3;
            text += `; ${said(b)}; difference (${apart.map(digits).join(', ')}), relMSE ${digits(error)}`;
        }
        this.readout.textContent = text;
    }
}

/// The pictures in an <img>: of a strip each tile, 256 pixels and a border of 2, below a label.
function picturesOf(img) {
    const {naturalWidth: width, naturalHeight: height} = img, side = 256, border = 2, label = 24;
    const isStrip = height === side + label && width % (side + 2 * border) === 0;
    const tiles = isStrip ? width / (side + 2 * border) : 1;
    const canvas = make('canvas', {width, height}), paint = canvas.getContext('2d');
    paint.drawImage(img, 0, 0);
    const names = (img.dataset.names || '').split('|');
    return Array.from({length: tiles}, (_, t) => {
        const data = isStrip ? paint.getImageData(t * (side + 2 * border) + border, label, side, side) :
            paint.getImageData(0, 0, width, height);
        const pixels = Float32Array.from(data.data, (code, i) => i % 4 === 3 ? 1 : fromSrgb[code]);
        const name = isStrip && names.length === tiles ? names[t] : img.alt || 'picture';
        return {name, width: data.width, height: data.height, pixels};
    });
}

/// Opens the pictures of an <img>, with those beside it that have the same size.
function hold(img) {
    const near = [...img.closest('p, figure').querySelectorAll('img')].filter(other =>
        other.naturalWidth === img.naturalWidth && other.naturalHeight === img.naturalHeight);
    const viewer = new Viewer(), close = make('button', {type: 'button', class: 'close'}, 'close');
    const dialog = make('dialog', {'aria-label': 'pictures'}, close, viewer.node);
    close.onclick = () => dialog.close();
    dialog.onclose = () => dialog.remove();
    document.body.append(dialog);
    viewer.set(near.flatMap(picturesOf));
    dialog.showModal();
}

for (const img of document.querySelectorAll('main img[src^="data:image/png"]:not(.thumbnail)')) {
    const button = make('button', {type: 'button', class: 'hold', onclick: () => hold(img)}, 'hold this picture');
    img.onclick = () => hold(img);
    img.after(button);
}
