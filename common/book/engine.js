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

/// What data.js holds, unpacked: {module, worker, files}.
async function unpack() {
    const gzipped = Uint8Array.from(atob(packed), letter => letter.charCodeAt(0));
    const stream = new Blob([gzipped]).stream().pipeThrough(new DecompressionStream('gzip'));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer()), files = {};
    // A header of tar: the name, and at 124 the size in octal digits.
    for (let at = 0; bytes[at];) {
        const [name] = textOf(bytes.subarray(at, at + 100)).split('\0');
        const size = parseInt(textOf(bytes.subarray(at + 124, at + 135)), 8);
        files[name] = bytes.subarray(at + 512, at + 512 + size);
        at += 512 * (1 + Math.ceil(size / 512));
    }
    const {'live.js': glue, 'live.wasm': wasm, ...others} = files;
    const worker = URL.createObjectURL(new Blob([glue, workerText], {type: 'text/javascript'}));
    const data = {files: others, worker, module: await WebAssembly.compile(wasm)};
    const {files: {'out/knot.ply': knot}} = await new Run(data, 'make_knot', ['out/knot.ply'], {}, () => {}).done;
    return {...data, files: {...others, 'scenes/knot.ply': knot}};
}
const textOf = bytes => new TextDecoder().decode(bytes);
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

/// Pictures of parts of the samples as one: each pixel counts by its samples, which its fourth number tells.
function joined(parts) {
    const pixels = parts[0].pixels.map((_, i) => {
        let sum = 0, n = 0;
        for (const part of parts) {
            n += part.pixels[i | 3];
            sum += part.pixels[i] * part.pixels[i | 3];
        }
        return i % 4 === 3 ? n : n > 0 ? sum / n : 0;
    });
    return {...parts[0], pixels};
}

/// The mean of a picture, or of what `value` makes of each number in it.
function mean({pixels}, value = x => x) {
    return pixels.reduce((sum, x, i) => i % 4 === 3 ? sum : sum + value(x, i), 0) / (pixels.length / 4 * 3);
}
/// relMSE = mean((a - b)^2 / (b^2 + 0.01)), as build/compare has it.
const relMse = (a, b) => mean(b, (x, i) => (a.pixels[i] - x) ** 2 / (x ** 2 + 0.01));
