// What the live part of each chapter's page offers: its own options, as the program knows them.
// A choice names all values, the default first; a number has its default.
// against: what it races with at first, if not with the chapter before it
const choice = (name, label, ...values) => ({name, label, values});
const number = (name, label, value) => ({name, label, value});

// kind  film: samples come one after the other;  once: one picture;  table: no scene, n samples
const chapters = {
    '01_monte_carlo_pi': {kind: 'table', n: 1 << 20},
    '02_stratification': {kind: 'table', n: 1024},
    '03_point_sets': {kind: 'table', n: 1024},
    '04_importance': {kind: 'table', n: 1000000},
    '05_ray_casting': {kind: 'film', scene: 'cornell-spheres'},
    '06_bvh': {
        // The table needs a clock of the processor.
        kind: 'once', scene: 'knot', words: ['--quiet'],
        own: [choice('step', 'work of', 'ordered', 'linear', 'median', 'sah', 'four')]
    },
    '07_path_tracing': {kind: 'film', scene: 'cornell'},
    '08_russian_roulette': {kind: 'film', scene: 'cornell'},
    '09_light_sampling': {
        kind: 'film', scene: 'cornell',
        own: [choice('light-by', 'points on lights by', 'solid-angle', 'area')]
    },
    '10_cosine_sampling': {kind: 'film', scene: 'cornell'},
    '11_light_importance': {kind: 'film', scene: 'thousand-lights'},
    '12_ris': {kind: 'film', scene: 'thousand-lights', own: [number('m', 'candidates M', 16)]},
    '13_glossy': {
        kind: 'film', scene: 'veach-mis', against: '13_glossy',
        own: [choice('strategy', 'find light by', 'light', 'bsdf')]
    },
    '14_mis': {
        kind: 'film', scene: 'veach-mis',
        own: [choice('heuristic', 'heuristic', 'power', 'balance')]
    },
    '15_mis_ris': {kind: 'film', scene: 'thousand-lights', own: [number('m', 'candidates M', 64)]},
    '16_lens_and_shutter': {
        kind: 'film', scene: 'bokeh', against: '16_lens_and_shutter',
        own: [number('m', 'candidates M', 64), choice('pixel', 'of each pixel', 'area', 'centre')]
    },
    '17_sky_image': {
        kind: 'film', scene: 'sky', against: '17_sky_image',
        own: [number('m', 'candidates M', 64), choice('compensation', 'compensation', 'on', 'off')]
    },
    '18_dispersion': {
        kind: 'film', scene: 'prism', against: '18_dispersion',
        own: [number('m', 'candidates M', 64)]
    },
    '19_adaptive': {
        kind: 'film', scene: 'high-contrast',
        own: [number('pilot', 'samples of the pilot', 16),
              choice('judge', 'a half is judged by', 'other', 'own')]
    },
    '20_light_tracing': {kind: 'film', scene: 'caustic', against: '15_mis_ris'},
    '21_bidirectional': {
        kind: 'film', scene: 'cornell-spheres', against: '15_mis_ris',
        own: [choice('strategy', 'strategy s,t', 'all', '0,2', '0,3', '1,2', '2,1', '3,1', '2,2')]
    },
    '22_fast_bidirectional': {
        kind: 'film', scene: 'cornell-spheres',
        own: [number('chances', 'chances through mirrors', 16),
              choice('direct-by', 'direct light as in chapter', '15', '21')]
    },
    '23_photon_mapping': {
        kind: 'film', scene: 'pool', spp: 8,
        own: [number('photons', 'light paths in each pass', 100000),
              choice('gather', 'gather photons', 'final', 'direct')]
    },
    '24_progressive_photons': {
        kind: 'film', scene: 'pool', spp: 8,
        own: [number('photons', 'light paths in each pass', 100000),
              choice('gather', 'gather photons', 'final', 'direct')]
    },
    '25_vertex_merging': {
        kind: 'film', scene: 'sds', against: '22_fast_bidirectional', spp: 8,
        own: [number('photons', 'light paths in each pass (0: automatic)', 0)]
    },
    '26_radiosity': {
        kind: 'once', scene: 'cornell',
        own: [number('patches', 'patches at least', 1200),
              number('shots', 'shots at most', 1000),
              choice('show', 'show', 'smooth', 'constant')]
    }
};
