// Headless Firefox, driven by its own protocol (Marionette) over a local socket: the same calls as Browser.
const {Browser} = require('./browser.js'), {spawn} = require('child_process'), fs = require('fs'), net = require('net'), os = require('os'), path = require('path');

const settings = {
    'marionette.port': 0,  // one that is free
    'devtools.console.stdout.content': true,
    'browser.dom.window.dump.enabled': true,
    'network.proxy.type': 1,  // no network: all goes to a port where nobody is
    ...Object.fromEntries(['http', 'ssl', 'socks'].flatMap(kind =>
        [[`network.proxy.${kind}`, '127.0.0.1'], [`network.proxy.${kind}_port`, 9]])),
};
const keys = {ArrowRight: '\uE014', ArrowLeft: '\uE012', ArrowDown: '\uE015', Enter: '\uE007', Tab: '\uE004'};

/// What Browser (browser.js) is for Chromium.
class Firefox {
    until = Browser.prototype.until;
    close = Browser.prototype.close;
    constructor(program) {
        this.profile = fs.mkdtempSync(path.join(os.tmpdir(), 'book-'));
        fs.writeFileSync(path.join(this.profile, 'user.js'), Object.entries(settings)
            .map(([name, value]) => `user_pref(${JSON.stringify(name)}, ${JSON.stringify(value)});\n`).join(''));
        this.process = spawn(program, ['--headless', '--marionette', '--remote-allow-system-access', '--profile', this.profile,
            '--no-remote'], {stdio: ['ignore', 'pipe', 'pipe']});
        this.waiting = new Map(), this.last = 0, this.problems = [];
        // RSLoader is a part of Firefox that wants the network.
        for (const stream of [this.process.stdout, this.process.stderr]) {
            stream.on('data', text => this.problems.push(...String(text).split('\n')
                .filter(line => /^JavaScript error: (file|blob)|^console\.error(?!: RSLoader)/.test(line))));
        }
    }
    async connect() {
        const file = path.join(this.profile, 'MarionetteActivePort');
        for (const end = Date.now() + 60000; !fs.existsSync(file);) {
            if (Date.now() > end) throw new Error('Firefox did not start');
            await new Promise(resolve => setTimeout(resolve, 100));
        }
        this.socket = net.connect(+fs.readFileSync(file, 'utf8'), '127.0.0.1');
        let bytes = Buffer.alloc(0);
        this.socket.on('data', more => {
            bytes = Buffer.concat([bytes, more]);
            for (let colon; (colon = bytes.indexOf(':')) > 0;) {
                const end = colon + 1 + +bytes.subarray(0, colon);
                if (bytes.length < end) return;
                this.take(JSON.parse(bytes.subarray(colon + 1, end)));
                bytes = bytes.subarray(end);
            }
        });
    }
    take(message) {
        if (!Array.isArray(message)) return;  // its greeting
        const [, id, error, result] = message, {resolve, reject} = this.waiting.get(id);
        this.waiting.delete(id);
        if (error) reject(new Error(`${error.error}: ${error.message}`)); else resolve(result);
    }
    send(command, parameters = {}, of = 'WebDriver') {
        const id = ++this.last, text = JSON.stringify([0, id, `${of}:${command}`, parameters]);
        this.socket.write(`${Buffer.byteLength(text)}:${text}`);
        return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
    }
    async start() {
        await this.connect();
        await this.send('NewSession', {capabilities: {alwaysMatch: {}}});
        await this.send('SetTimeouts', {script: 600000, pageLoad: 60000});
    }
    open(file) { return this.send('Navigate', {url: `file://${file}`}); }
    async value(expression) {
        return (await this.send('ExecuteScript', {script: 'return window.eval(arguments[0])', args: [expression]})).value;
    }
    /// Lets the browser itself, not the page, do something.
    async do(script) {
        await this.send('SetContext', {value: 'chrome'}, 'Marionette');
        await this.send('ExecuteScript', {script, args: []});
        await this.send('SetContext', {value: 'content'}, 'Marionette');
    }
    dark(is) { return this.do(`Services.prefs.setIntPref('layout.css.prefers-color-scheme.content-override', ${is ? 0 : 1})`); }
    /// No window is narrower than 450 pixels here, but the page in it can be.
    async width(width, height = 900) {
        await this.send('SetWindowRect', {width, height});
        await this.do(`gBrowser.selectedBrowser.style.maxWidth = '${width}px'`);
    }
    perform(type, id, actions, more) { return this.send('PerformActions', {actions: [{type, id, actions, ...more}]}); }
    key(key) {
        const value = keys[key] || key;
        return this.perform('key', 'keys', [{type: 'keyDown', value}, {type: 'keyUp', value}]);
    }
    click(x, y) {
        return this.perform('pointer', 'mouse', [{type: 'pointerMove', x: Math.round(x), y: Math.round(y)},
            {type: 'pointerDown', button: 0}, {type: 'pointerUp', button: 0}], {parameters: {pointerType: 'mouse'}});
    }
    async screenshot(file) {
        fs.writeFileSync(file, Buffer.from((await this.send('TakeScreenshot', {full: false})).value, 'base64'));
    }
}
module.exports = {Firefox};
