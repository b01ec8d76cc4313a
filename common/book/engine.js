// Runs the programs of the chapters, which data.js holds as one WebAssembly module, in workers.

/// The text of a worker. The module's own glue comes before it.
const workerText = `
onmessage = async ({data: job}) => {
    const begin = performance.now();
    const send = (kind, value, owned = []) => postMessage({kind, ...value}, owned);
    try {
        const live = await Live({
            thisProgram: 'build/' + job.program,
            instantiateWasm(imports, done) {
                WebAssembly.instantiate(job.module, imports).then(done);
                return {};
            },
            print: text => send('out', {text}),
            printErr: text => send('error', {text}),
            show(width, height, pixels, mean, error) {
                const seconds = (performance.now() - begin) / 1000;
                send('show', {width, height, pixels, mean, error, seconds}, [pixels.buffer]);
            }
        });
        for (const [name, content] of Object.entries(job.files)) {
            const folder = name.slice(0, name.lastIndexOf('/'));
            live.FS.mkdirTree('/' + folder);
            live.FS.writeFile('/' + name, content);
        }
        live.FS.mkdirTree('/out/classes');
        const code = live.callMain(job.args);
        const files = {};
        for (const folder of ['/out', '/out/classes']) {
            for (const name of live.FS.readdir(folder)) {
                const path = folder + '/' + name;
                if (live.FS.isFile(live.FS.stat(path).mode)) files[path.slice(1)] = live.FS.readFile(path);
            }
        }
        send('done', {code, files});
    } catch (error) {
        send('error', {text: 'error: the program broke off: ' + error});
        send('done', {code: 1, files: {}});
    }
};`;

/// What data.js holds, unpacked: {module, size (bytes), worker, scenes, files, references}.
async function unpack() {
    if (typeof packed === 'undefined') {
        await new Promise(ready => window.addEventListener('packed', ready));
    }
    const gzipped = Uint8Array.from(atob(packed), letter => letter.charCodeAt(0));
    const stream = new Blob([gzipped]).stream().pipeThrough(new DecompressionStream('gzip'));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    let at = bytes.indexOf(10);
    const text = part => new TextDecoder().decode(part), list = JSON.parse(text(bytes.subarray(0, at++)));
    const data = {scenes: {}, files: {}, references: {}};
    for (const [name, length] of list) {
        const content = bytes.subarray(at, at += length);
        if (name.startsWith('references/')) data.references[name.slice(11)] = content;
        else if (name.endsWith('.pbrt')) data.scenes[name] = text(content);
        else data.files[name] = content;
    }
    const {'live.js': glue, 'live.wasm': wasm, ...files} = data.files;
    const worker = URL.createObjectURL(new Blob([glue, workerText], {type: 'text/javascript'}));
    const all = {...data, files, worker, module: await WebAssembly.compile(wasm), size: wasm.length};
    await Promise.all(made.map(async name => {
        const program = name.replace(/scenes\/(.*)\..*/, 'make_$1'), written = name.replace('scenes', 'out');
        const content = (await new Run(all, program, [written], {}, () => {}).done).files[written];
        if (name.endsWith('.pbrt')) all.scenes[name] = text(content); else all.files[name] = content;
    }));
    return all;
}
const engine = unpack();

/// One run of a program. show({width, height, pixels, mean, error, seconds}) is called now and then;
/// done is a promise of {code, files, out, errors}, where a run that is stopped has the code null.
class Run {
    constructor(data, program, args, files, show) {
        const out = [], errors = [];
        this.worker = new Worker(data.worker);
        this.done = new Promise(resolve => {
            this.end = (code, files) => {
                this.worker.terminate();
                resolve({code, files, out, errors});
            };
        });
        this.worker.onmessage = ({data: message}) => {
            if (message.kind === 'show') show(message);
            if (message.kind === 'out') out.push(message.text);
            if (message.kind === 'error') errors.push(message.text);
            if (message.kind === 'done') this.end(message.code, message.files);
        };
        this.worker.postMessage({module: data.module, program, args, files});
    }
    stop() { this.end(null, {}); }
}

/// The picture of a .pfm file: {width, height, pixels}, four numbers a pixel from the top left.
function readPfm(bytes) {
    let at = 0;
    const word = () => {
        let text = '';
        while (bytes[at] > 32) text += String.fromCharCode(bytes[at++]);
        at++;
        return text;
    };
    word();
    const width = +word(), height = +word();
    word();
    const floats = new Float32Array(bytes.slice(at).buffer);
    const pixels = new Float32Array(4 * width * height);
    for (let y = 0; y < height; y++) {
        for (let x = 0; x < width; x++) {
            const from = 3 * ((height - 1 - y) * width + x), to = 4 * (y * width + x);
            pixels.set(floats.subarray(from, from + 3), to);
        }
    }
    return {width, height, pixels};
}

/// Pictures of parts of the samples as one: each pixel counts by its samples, which its fourth
/// number tells.
function joined(parts) {
    if (parts.length === 1) return parts[0];
    const {width, height} = parts[0], pixels = new Float32Array(4 * width * height);
    for (let i = 0; i < pixels.length; i += 4) {
        let n = 0;
        for (const part of parts) n += part.pixels[i + 3];
        for (const part of parts) {
            const share = n > 0 ? part.pixels[i + 3] / n : 0;
            for (let k = 0; k < 3; k++) pixels[i + k] += share * part.pixels[i + k];
        }
        pixels[i + 3] = n;
    }
    return {width, height, pixels};
}

/// relMSE = mean((a - b)^2 / (b^2 + 0.01)), as build/compare has it.
function relMse(a, b) {
    let sum = 0;
    for (let i = 0; i < a.pixels.length; i++) {
        if (i % 4 === 3) continue;
        const d = a.pixels[i] - b.pixels[i];
        sum += d * d / (b.pixels[i] ** 2 + 0.01);
    }
    return sum / (a.pixels.length / 4 * 3);
}
