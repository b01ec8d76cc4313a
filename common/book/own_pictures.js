// Two pictures of the reader's own, beside each other, with the verdict of the compiled `compare`.

const own = [], viewer = new Viewer(), said = make('pre', {class: 'printed', tabindex: 0, hidden: true});
const problem = make('p', {class: 'errors', role: 'alert'});
const inputs = ['A', 'B, the reference'].map((label, k) => make('input', {
    type: 'file', accept: '.pfm,.ppm,.png', 'aria-label': `Picture ${label}`, onchange: event => take(k, event.target.files)
}));
document.querySelector('.own').replaceChildren(...inputs.map((input, k) =>
    make('p', {}, `Picture ${['A', 'B, the reference'][k]}: `, input)), problem, viewer.node, said);

async function take(k, [file]) {
    if (!file) return;
    own[k] = {bytes: new Uint8Array(await file.arrayBuffer()), name: file.name, path: `${'AB'[k]}/${file.name}`};
    if (own[0] && own[1]) await compare();
}
async function compare() {
    viewer.node.hidden = said.hidden = true;
    const files = Object.fromEntries(own.map(({path, bytes}) => [path, bytes]));
    const {code, out, errors} = await new Run(await engine, 'compare', own.map(({path}) => path), files, () => {}).done;
    problem.textContent = errors.join('\n');
    if (code !== 0) return;
    said.hidden = false, said.textContent = out.join('\n');
    viewer.set(await Promise.all(own.map(async ({bytes, name}) => ({...await readPicture(bytes), name}))));
}
