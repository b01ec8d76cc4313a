// The live part of a chapter's page: its program, run in this page.

/// A number or a choice of the form, as its label and field.
function field(name, label, attributes, values) {
    const input = values ?
        make('select', {name, ...attributes}, ...values.map(value => make('option', {}, value))) :
        make('input', {name, ...attributes});
    return make('label', {}, `${label} `, input);
}
const sceneFile = name => `scenes/${name}.pbrt`;

class Live {
    constructor(name, data) {
        this.name = name, this.data = data, this.about = chapters[name], this.runs = [];
        this.viewer = new Viewer();
        this.status = make('p', {class: 'status', role: 'status'},
            `ready: the programs of all chapters are ${(data.size / 1e6).toFixed(1)} MB of WebAssembly`);
        this.errors = make('ul', {class: 'errors', role: 'alert'});
        this.text = make('pre', {class: 'printed', tabindex: 0, hidden: true});
        this.form = make('form', {class: 'options'}, ...this.fields(),
            make('button', {type: 'submit', class: 'go'}, 'Render'),
            make('button', {type: 'button', class: 'stop', disabled: true, onclick: () => this.stop()}, 'Stop'));
        this.form.onsubmit = event => { event.preventDefault(); this.render(); };
        this.node = make('section', {class: 'live', 'aria-label': 'live'},
            make('h2', {id: 'live'}, 'Try it here'),
            this.form, this.errors, this.viewer.node, this.status, this.text);
        if (this.about.kind === 'film') this.node.append(layers(this), race(this));
        if (this.about.kind !== 'table') this.node.insertBefore(this.editor(), this.errors);
        if (this.about.kind === 'film') this.viewer.pick = ([x, y]) => this.tell(x, y);
    }

    fields() {
        const about = this.about, own = (about.own || []).map(o => o.values ?
            field(o.name, o.label, {'data-own': true}, o.values) :
            field(o.name, o.label, {'data-own': true, type: 'number', min: Math.min(1, o.value), value: o.value}));
        const seed = field('seed', 'seed', {type: 'number', min: 0, value: 0});
        if (about.kind === 'table') return [field('n', 'samples', {type: 'number', min: 1, value: about.n}), seed];
        const names = Object.keys(this.data.scenes).map(file => file.slice(7, -5));
        const scene = field('scene', 'scene', {}, [about.scene, ...names.filter(n => n !== about.scene)]);
        const size = field('size', 'size', {}, ['256x256', '24x24', '64x64', '128x128', '512x512']);
        if (about.kind === 'once') return [scene, size, ...own];
        return [scene, size, field('spp', 'samples per pixel', {type: 'number', min: 1, value: about.spp || 16}),
            field('sampler', 'sampler', {}, ['independent', 'stratified', 'sobol']), seed,
            field('max-depth', 'longest path', {type: 'number', min: 0, placeholder: 'of the scene'}),
            field('paths', 'classes', {placeholder: 'all; LD(S|D)*E', size: 12}), ...own];
    }

    /// Sets fields of the form.
    fill(values) {
        for (const [name, value] of Object.entries(values)) {
            const input = this.form.elements[name];
            if (!input) continue;
            input.value = value;
            input.dispatchEvent(new Event('change'));
        }
    }
    /// The scene's text, which may be changed.
    editor() {
        this.editing = make('textarea', {spellcheck: 'false', rows: 14, 'aria-label': 'text of the scene'});
        const scene = this.form.elements.scene;
        const fill = () => { this.editing.value = this.data.scenes[sceneFile(scene.value)]; };
        scene.onchange = fill;
        fill();
        return make('details', {class: 'editor'}, make('summary', {}, 'The scene, to be changed'), this.editing);
    }

    /// The options in the form, as words.
    options(form = this.form) {
        const words = [];
        for (const input of form.elements) {
            if (!input.name || input.name === 'scene' || input.name === 'n' || input.value === '') continue;
            const isDefault = (this.about.own || []).some(o => o.name === input.name && o.values?.[0] === input.value);
            if (!isDefault) words.push(`--${input.name}`, input.value);
        }
        return words;
    }
    files() {
        const files = {...this.data.files, ...this.data.scenes};
        if (this.editing) files[sceneFile(this.form.elements.scene.value)] = this.editing.value;
        return files;
    }
    start(program, args, show = () => {}) {
        const run = new Run(this.data, program, [...args, '--threads', '1'], this.files(), show);
        this.runs.push(run);
        return run.done;
    }
    stop() {
        for (const run of this.runs) run.stop();
        this.runs = [];
    }
    busy(is) {
        this.form.querySelector('.stop').disabled = !is;
        this.node.classList.toggle('busy', is);
    }

    async render() {
        this.stop();
        this.errors.replaceChildren();
        this.viewer.overlay.replaceChildren();
        this.busy(true);
        this.began = performance.now(), this.first = null;
        const kind = this.about.kind;
        const done = await (kind === 'table' ? this.table() : kind === 'once' ? this.once() : this.film());
        this.busy(false);
        if (done.code === null) this.status.textContent += ', stopped';
        else this.report(done);
    }
    /// One run that shows all at its end.
    once() {
        this.status.textContent = 'working';
        return this.start(this.name, [this.sceneName(), ...this.options(), ...this.about.words || [],
            '--out', 'out/picture.pfm']);
    }
    sceneName() { return sceneFile(this.form.elements.scene.value); }

    /// More and more samples, up to those asked for.
    async table() {
        const n = +this.form.elements.n.value, seed = this.form.elements.seed.value;
        let done;
        for (const share of [64, 8, 1]) {
            const some = Math.max(1, Math.floor(n / share));
            const words = ['--n', `${some}`, '--seed', seed, '--out', 'out/picture.pfm'];
            const run = new Run(this.data, this.name, words, {}, () => {});
            this.runs.push(run);
            done = await run.done;
            if (done.code !== 0) return done;
            if (share > 1) this.report(done);
        }
        return done;
    }

    /// Parts of the samples in several workers, each into a film of its own; then all as one.
    async film() {
        const spp = Math.max(1, +this.form.elements.spp.value);
        const parts = Math.max(1, Math.min(navigator.hardwareConcurrency || 1, spp, 8));
        const shown = [], films = [];
        this.workers = parts;
        const runs = Array.from({length: parts}, (_, k) => this.start(this.name, [
            this.sceneName(), ...this.options(), '--film', `out/${k}.film`, '--film-every', '0.1', '--part',
            `${k + 1}/${parts}`, '--out', 'out/picture.pfm'
        ], message => {
            // Drawn once for all workers, since they are about equally far.
            shown[k] = message;
            if (k === 0) this.progress(shown.filter(Boolean));
        }));
        const results = await Promise.all(runs);
        const failed = results.find(result => result.code !== 0);
        if (failed || parts === 1) return failed || results[0];
        const files = {};
        results.forEach((result, k) => {
            files[`in/${k}.film`] = result.files[`out/${k}.film`];
            films.push(`in/${k}.film`);
        });
        const merge = new Run(this.data, 'merge', ['out/picture.pfm', ...films], files, () => {});
        const whole = await merge.done;
        return {...whole, out: [...results[0].out.slice(0, 1), ...whole.out]};
    }
    progress(parts) {
        const picture = joined(parts);
        this.first ??= performance.now() - this.began;
        let n = 0;
        for (let i = 3; i < picture.pixels.length; i += 4) n += picture.pixels[i];
        this.viewer.set([{...picture, name: this.name}]);
        this.status.textContent = `${(n / picture.pixels.length * 4).toFixed(1)} samples per pixel, ` +
            `mean ${parts[0].mean.toPrecision(5)} ± ${parts[0].error.toPrecision(2)}, ${this.seconds()} s`;
    }
    seconds() { return ((performance.now() - this.began) / 1000).toFixed(1); }

    report({code, files, out, errors}) {
        this.result = files;
        if (files['out/picture.pfm']) {
            const picture = readPfm(files['out/picture.pfm']);
            this.first ??= performance.now() - this.began;
            this.viewer.set([{...picture, name: this.name}]);
        }
        this.text.hidden = out.length === 0;
        this.text.textContent = out.filter(line => !line.startsWith('wrote ')).join('\n');
        this.complain(errors);
        if (code !== 0) this.status.textContent = `the program ended with code ${code}`;
        else {
            this.status.textContent = `done in ${this.seconds()} s; first picture after ` +
                `${this.first.toFixed(0)} ms${this.speed()}`;
        }
    }
    speed() {
        if (this.about.kind !== 'film') return '';
        const {width, height} = this.viewer.pictures[0];
        const rate = width * height * this.form.elements.spp.value / (performance.now() - this.began) / 1000;
        return `; ${rate.toPrecision(2)} M samples/s with ${this.workers} worker${this.workers > 1 ? 's' : ''}`;
    }
    /// Lists errors; a click, or the first of them, goes to the place in the scene that it names.
    complain(errors) {
        this.errors.replaceChildren(...errors.map(line => {
            const [, row, column] = line.match(/\.pbrt:(\d+):(\d+): /) || [];
            const go = () => this.goTo(+row, +column);
            return make('li', {}, row ? make('button', {type: 'button', onclick: go}, line) : line);
        }));
        this.errors.querySelector('button')?.click();
    }
    goTo(row, column) {
        const lines = this.editing.value.split('\n');
        const at = lines.slice(0, row - 1).reduce((sum, line) => sum + line.length + 1, 0) + column - 1;
        const word = this.editing.value.slice(at).match(/^("[^"\n]*"|\S*)/)[0];
        this.editing.closest('details').open = true;
        this.editing.focus();
        this.editing.setSelectionRange(at, at + Math.max(1, word.length));
        const height = parseFloat(getComputedStyle(this.editing).lineHeight);
        this.editing.scrollTop = (row - 4) * height;
    }

    /// The story of a path through a pixel, drawn into the picture.
    async tell(x, y) {
        if (!this.result) return;
        if (this.told?.x === x && this.told.y === y) this.told.sample++;
        else this.told = {x, y, sample: 0};
        const spp = Math.max(1, +this.form.elements.spp.value), sample = this.told.sample % spp;
        const done = await this.start(this.name, [this.sceneName(), ...this.options(), '--explain',
            `${x},${y},${sample}`, '--out', 'out/path.ppm']);
        this.complain(done.errors);
        if (done.code !== 0) return;
        this.text.hidden = false;
        this.text.textContent = done.out.filter(line => !line.startsWith('wrote ')).join('\n') +
            '\n\nClick the same pixel again (or press Enter) to see its next sample.';
        this.lay(new TextDecoder().decode(done.files['out/path.svg']));
    }
    /// Lays the drawing of a path over the picture: of its two panels that of the camera, whose frame
    /// is the first rectangle without a filling; without the background and the small picture that are in it.
    lay(text) {
        const over = new DOMParser().parseFromString(text, 'image/svg+xml').documentElement;
        const frame = over.querySelector('rect[fill="none"]');
        if (!frame) return;
        for (const cover of over.querySelectorAll('image, rect[fill="white"]')) cover.remove();
        const sides = ['x', 'y', 'width', 'height'].map(name => frame.getAttribute(name));
        over.setAttribute('viewBox', sides.join(' '));
        over.removeAttribute('width'), over.removeAttribute('height');
        this.viewer.overlay.replaceChildren(over);
    }
}

// The live part stands before the second section.
const here = document.body.dataset.chapter;
if (here && chapters[here]) {
    const after = document.querySelectorAll('main h2')[1] || document.querySelector('.turn');
    const waiting = make('p', {class: 'status'}, 'The live part is being unpacked.');
    after.before(waiting);
    engine.then(data => {
        window.live = new Live(here, data);
        waiting.replaceWith(window.live.node);
    }).catch(error => { waiting.textContent = `No live part in this browser: ${error.message}`; });
}
