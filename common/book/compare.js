// Beside a chapter's live picture: its layers by class of path, and a second method in equal time.

/// A button that splits the picture by classes of path, and the list of them.
function layers(live) {
    const list = make('div', {class: 'choices layers'});
    const split = make('button', {type: 'button'}, 'Split by classes of path');
    split.onclick = async () => {
        list.textContent = 'working';
        const {code, files, errors} = await live.start(live.name, [...live.words(), '--out', 'out/picture.pfm',
            '--split', 'out/classes']);
        list.textContent = '';
        live.complain(errors);
        if (code !== 0) return;
        const whole = readPfm(files['out/picture.pfm'], 'all');
        const classes = Object.keys(files).filter(file => file.startsWith('out/classes/') && file.endsWith('.pfm'));
        const found = classes.map(file => readPfm(files[file], file.slice(12, -4)));
        found.sort((a, b) => mean(b) - mean(a));
        live.viewer.set([whole, found[0]]);
        list.append(...[whole, ...found].map(picture => make('button', {
            type: 'button', onclick: () => live.viewer.set([whole, picture])
        }, `${picture.name} ${(100 * mean(picture) / mean(whole)).toFixed(1)} %`)));
    };
    return make('div', {class: 'by-class'}, split, list);
}

/// Two methods side by side in equal time, and their error as it falls.
function race(live) {
    const names = Object.keys(chapters).filter(name => chapters[name].kind === 'film');
    const other = field('other', 'against', {}, names), before = names[names.indexOf(live.name) - 1];
    other.lastChild.value = live.about.against || before || names[1];
    const words = field('words', 'with', {placeholder: 'its options', size: 18});
    const time = field('time', 'seconds each', {type: 'number', min: 1, value: 5});
    const chart = make('div', {class: 'chart'}), viewer = new Viewer(), said = make('p', {class: 'status', role: 'status'});
    const form = make('form', {class: 'options'}, other, words, time, make('button', {type: 'submit'}, 'Race'));
    form.onsubmit = event => {
        event.preventDefault();
        live.stop();
        const fields = form.elements, all = live.options(), shared = ['size', 'sampler', 'seed', 'max-depth', 'paths'];
        // A method's own options, and those that every chapter understands.
        const common = all.filter((_, i) => shared.includes(all[i - i % 2].slice(2)));
        const mine = all.filter((_, i) => all[i - i % 2] !== '--spp');
        return run_race({live, viewer, chart, said, seconds: +fields.time.value}, [{name: live.name, words: mine},
            {name: fields.other.value, words: [...common, ...fields.words.value.match(/\S+/g) || []]}]);
    };
    return make('details', {class: 'race'}, make('summary', {}, 'Two methods in equal time'), form, viewer.node,
        chart, said);
}

/// Runs both methods for the same time. If there is a reference of the scene, both render in its size and
/// are compared with it; else the error is the one that each film tells of itself.
async function run_race({live, viewer, chart, said, seconds}, methods) {
    const scene = live.sceneName(), {files} = live.data, isChanged = live.editing.value !== textOf(files[scene]);
    const file = scene.replace('scenes/', 'tests/measure/references/').replace('pbrt', 'pfm');
    const reference = files[file] && !isChanged && readPfm(files[file], 'reference');
    const shown = [], size = reference ? ['--size', `${reference.width}x${reference.height}`] : [];
    const what = reference ? 'relMSE' : '(standard error of the mean / mean)²';
    for (const method of methods) method.points = [];
    said.textContent = 'working';
    const runs = methods.map((method, k) => live.start(method.name, [scene, ...method.words, ...size, '--time', `${seconds}`,
        '--film', 'out/x.film', '--film-every', '0.1', '--out', 'out/picture.pfm'
    ], message => {
        shown[k] = {...message, name: method.name};
        const error = reference ? relMse(message, reference) : (message.error / message.mean) ** 2;
        if (error > 0 && Number.isFinite(error)) method.points.push([message.seconds, error]);
        if (shown[0] && shown[1]) viewer.set([...shown, ...reference ? [reference] : []]);
        draw_chart(chart, what, methods);
    }));
    const results = await Promise.all(runs), last = methods.map(method => method.points.at(-1)?.[1]);
    live.complain(results.flatMap(result => result.errors));
    if (results.some(result => result.code !== 0)) said.textContent = '';
    else if (!last[0] || !last[1]) said.textContent = 'too little time';
    else {
        said.textContent = `${what}: ${methods[0].name} ${digits(last[0])}, ${methods[1].name} ${digits(last[1])}; ` +
            `in equal time the first is ${digits(last[1] / last[0])} times as efficient` +
            (reference ? `. Both rendered ${size[1]} pixels, the size of the reference.` : '');
    }
}

/// Error against time, both logarithmic.
function draw_chart(chart, what, methods) {
    const points = methods.flatMap(method => method.points), range = k => [Math.min, Math.max]
        .map(end => end(...points.map(point => point[k])));
    if (points.length < 3) return;
    const [[t0, t1], [e0, e1]] = [range(0), range(1)];
    const share = (v, low, high) => Math.log(v / low) / Math.log(high / low);
    const place = ([t, e]) => `${(300 * share(t, t0, t1)).toFixed(1)},${(170 - 170 * share(e, e0, e1)).toFixed(1)}`;
    const curves = methods.map((method, k) =>
        `<polyline class="curve${k + 1}" points="${method.points.map(place).join(' ')}"/>`);
    chart.innerHTML = `${what}, from ${digits(e1)} to ${digits(e0)}
        <svg viewBox="-5 -5 310 180" role="img" aria-label="error against time">${curves.join('')}</svg>
        ${digits(t0)} to ${digits(t1)} seconds; both axes are logarithmic.
        <span class="name1">${methods[0].name}</span>, <span class="name2">${methods[1].name}</span>`;
}
