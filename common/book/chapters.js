// What the live part of each chapter's page offers: its own options, as the program knows them.
// A choice names all values, the default first; a number has its default.
const choice = (name, ...values) => ({name, values});
const number = (name, value) => ({name, value});
// kind  film: samples come one after the other;  once: one picture, of a scene or of n samples
// against: what it races with at first, if not with the chapter before it
const film = (scene, own = [], more = {}) => ({kind: 'film', scene, own, spp: 16, ...more});
const once = (scene, own, more) => ({kind: 'once', scene, own, ...more});
const table = n => ({kind: 'once', n});
const gather = [number('photons', 100000), choice('gather', 'final', 'direct')];
const chapters = {
    '01_monte_carlo_pi': table(1 << 20),
    '02_stratification': table(1024),
    '03_point_sets': table(1024),
    '04_importance': table(1000000),
    '05_ray_casting': film('cornell-spheres'),
    // Its table needs a clock of the processor.
    '06_bvh': once('knot', [choice('step', 'ordered', 'linear', 'median', 'sah', 'four')], {words: ['--quiet']}),
    '07_path_tracing': film('cornell'),
    '08_russian_roulette': film('cornell'),
    '09_light_sampling': film('cornell', [choice('light-by', 'solid-angle', 'area')]),
    '10_cosine_sampling': film('cornell'),
    '11_light_importance': film('thousand-lights'),
    '12_ris': film('thousand-lights', [number('m', 16)]),
    '13_glossy': film('veach-mis', [choice('strategy', 'light', 'bsdf')], {against: '13_glossy'}),
    '14_mis': film('veach-mis', [choice('heuristic', 'power', 'balance')]),
    '15_mis_ris': film('thousand-lights', [number('m', 64)]),
    '16_lens_and_shutter': film('bokeh', [number('m', 64), choice('pixel', 'area', 'centre')],
        {against: '16_lens_and_shutter'}),
    '17_sky_image': film('sky', [number('m', 64), choice('compensation', 'on', 'off')],
        {against: '17_sky_image'}),
    '18_dispersion': film('prism', [number('m', 64)], {against: '18_dispersion'}),
    '19_adaptive': film('high-contrast', [number('pilot', 16), choice('pilot-half', 'other', 'own')]),
    '20_light_tracing': film('caustic', [], {against: '15_mis_ris'}),
    '21_bidirectional': film('cornell-spheres',
        [choice('strategy', 'all', '0,2', '0,3', '1,2', '2,1', '3,1', '2,2')], {against: '15_mis_ris', spp: 4}),
    '22_fast_bidirectional': film('cornell-spheres', [number('extra-samples', 16), choice('direct-by', '15', '21')],
        {spp: 8}),
    '23_photon_mapping': film('pool', gather, {spp: 8}),
    '24_progressive_photons': film('pool', gather, {spp: 8}),
    '25_vertex_merging': film('sds', [number('photons', 0)], {against: '22_fast_bidirectional', spp: 4}),
    '26_radiosity': once('cornell',
        [number('patches', 1200), number('shots', 1000), choice('show', 'smooth', 'constant')])
};
