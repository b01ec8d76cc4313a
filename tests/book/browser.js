// Headless Chromium, driven over a pipe: node's own modules suffice.
const {spawn} = require('child_process'), fs = require('fs'), os = require('os'), path = require('path');

class Browser {
    /// Starts `program`, with no network: every name resolves to nothing.
    constructor(program) {
        this.profile = fs.mkdtempSync(path.join(os.tmpdir(), 'book-'));
        this.process = spawn(program, ['--headless', '--no-sandbox', '--disable-gpu', '--remote-debugging-pipe',
            '--host-resolver-rules=MAP * ~NOTFOUND', `--user-data-dir=${this.profile}`, 'about:blank'],
            {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
        this.waiting = new Map(), this.last = 0, this.problems = [];
        let text = '';
        this.process.stdio[4].on('data', bytes => {
            const messages = (text + bytes).split('\0');
            text = messages.pop();
            for (const message of messages) this.take(JSON.parse(message));
        });
    }
    take(message) {
        const {id, method, params, result, error} = message;
        if (id) {
            const {resolve, reject} = this.waiting.get(id);
            this.waiting.delete(id);
            return error ? reject(new Error(error.message)) : resolve(result);
        }
        if (method === 'Runtime.exceptionThrown') {
            const {text, exception} = params.exceptionDetails;
            this.problems.push(`${text} ${exception?.description || ''}`);
        }
        if (method === 'Log.entryAdded' && params.entry.level === 'error') this.problems.push(params.entry.text);
        if (method === 'Runtime.consoleAPICalled' && params.type === 'error') {
            this.problems.push(params.args.map(a => a.value).join(' '));
        }
        if (method === 'Network.requestWillBeSent' && /^(https?|wss?|ftp):/.test(params.request.url)) {
            this.problems.push(`asks the network for ${params.request.url}`);
        }
        if (method === 'Page.loadEventFired') this.loaded?.();
    }
    send(method, params = {}) {
        const id = ++this.last;
        this.process.stdio[3].write(JSON.stringify({id, method, params, sessionId: this.session}) + '\0');
        return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
    }
    async start() {
        const {targetInfos} = await this.send('Target.getTargets');
        const {targetId} = targetInfos.find(target => target.type === 'page');
        this.session = (await this.send('Target.attachToTarget', {targetId, flatten: true})).sessionId;
        for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await this.send(`${domain}.enable`);
    }
    async open(file) {
        const loaded = new Promise(resolve => { this.loaded = resolve; });
        await this.send('Page.navigate', {url: `file://${file}`});
        await loaded;
    }
    /// The value of an expression in the page, waited for when it is a promise.
    async value(expression) {
        const {result, exceptionDetails} = await this.send('Runtime.evaluate',
            {expression, awaitPromise: true, returnByValue: true});
        if (exceptionDetails) throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
        return result.value;
    }
    /// Waits until the expression is true.
    async until(expression, seconds = 30) {
        for (const end = Date.now() + 1000 * seconds; Date.now() < end;) {
            if (await this.value(expression)) return;
            await new Promise(resolve => setTimeout(resolve, 50));
        }
        throw new Error(`not within ${seconds} s: ${expression}`);
    }
    width(width, height = 900) {
        return this.send('Emulation.setDeviceMetricsOverride',
            {width, height, deviceScaleFactor: 1, mobile: width < 600});
    }
    dark(is) {
        return this.send('Emulation.setEmulatedMedia', {features: [{name: 'prefers-color-scheme', value: is ? 'dark' : 'light'}]});
    }
    key(key) {
        const text = key.length === 1 ? key : key === 'Enter' ? '\r' : undefined;
        return this.send('Input.dispatchKeyEvent', {type: 'keyDown', key, text, windowsVirtualKeyCode: {Tab: 9, Enter: 13}[key]});
    }
    async click(x, y) {
        for (const type of ['mousePressed', 'mouseReleased']) {
            await this.send('Input.dispatchMouseEvent', {type, x, y, button: 'left', clickCount: 1});
        }
    }
    async screenshot(file) {
        const {data} = await this.send('Page.captureScreenshot', {format: 'png'});
        fs.writeFileSync(file, Buffer.from(data, 'base64'));
    }
    async close() {
        const ended = new Promise(resolve => this.process.on('exit', resolve));
        this.process.kill();
        await ended;
        fs.rmSync(this.profile, {recursive: true, force: true});
    }
}
module.exports = {Browser};
