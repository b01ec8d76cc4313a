"""The fixed set of runs: what a user of the programs sees. Each is a command for bash, in an empty
folder; $B is the folder of the programs, $S that of the scenes, $T a folder of damaged input. What it
prints, its exit code and the files that it leaves are compared."""

import os


def all_runs():
    runs = []

    def add(command):
        runs.append(command)

    for chapter in ("01_monte_carlo_pi", "02_stratification", "03_point_sets", "04_importance"):
        add(f"$B/{chapter} --n 1000 --out a.pfm --out a.tsv")
        add(f"$B/{chapter} --n 36 --seed 2 --out a.png --quiet")
    for scene in ("cornell-spheres", "two-lights", "corner", "furnace"):
        add(f"$B/05_ray_casting $S/{scene}.pbrt --size 32x24 --spp 4 --threads 1 --out a.pfm --stats a.json")
    for scene in ("cornell-spheres", "near-light"):
        add(f"$B/06_bvh $S/{scene}.pbrt --size 32x24 --threads 1 --out a.pfm")

    # Every chapter on the scenes that it can render; those that it refuses say so.
    walks = ["07_path_tracing", "08_russian_roulette", "09_light_sampling", "10_cosine_sampling",
             "11_light_importance", "12_ris", "13_glossy", "14_mis", "15_mis_ris", "16_lens_and_shutter",
             "17_sky_image", "18_dispersion", "19_adaptive", "20_light_tracing", "21_bidirectional", "22_fast_bidirectional"]
    scenes = ["cornell-spheres", "two-lights", "veach-mis", "near-light", "corner", "sky", "prism",
              "moving-ball", "bokeh", "light-in-glass", "near-disk", "furnace", "hidden-light"]
    for number, chapter in enumerate(walks):
        for place, scene in enumerate(scenes):
            sampler = ("independent", "stratified", "sobol")[(number + place) % 3]
            add(f"$B/{chapter} $S/{scene}.pbrt --size 20x16 --spp 8 --threads 1 --sampler {sampler}"
                " --out a.pfm --stats a.json")
    for number, scene in enumerate(("pool", "caustic", "cornell-spheres", "near-light")):
        chapter = ("23_photon_mapping", "24_progressive_photons")[number % 2]
        add(f"$B/{chapter} $S/{scene}.pbrt --size 20x16 --spp 2 --photons 3000 --threads 1 --out a.pfm"
            " --stats a.json")
    for scene in ("sds", "caustic", "cornell-spheres", "light-in-glass"):
        add(f"$B/25_vertex_merging $S/{scene}.pbrt --size 20x16 --spp 3 --threads 1 --out a.pfm --stats a.json")
    for chapter in ("23_photon_mapping", "24_progressive_photons"):
        for words in ("--gather direct", "--gather final --radius 20"):
            add(f"$B/{chapter} $S/cornell-spheres.pbrt --size 16x12 --spp 2 --photons 2000 {words} --out a.pfm")
    for words in ("", "--solver jacobi --show constant", "--solver gauss-seidel", "--shots 40"):
        add(f"$B/26_radiosity $S/cornell.pbrt --patches 200 --size 24x24 --threads 1 --out a.pfm"
            f" --stats a.json {words}")
    add("$B/26_radiosity $S/near-light.pbrt --patches 150 --size 24x24 --threads 1 --out a.png")

    # Ways of a chapter, and what programs can do besides a picture.
    for words in ("09_light_sampling $S/near-light.pbrt --light-by area", "13_glossy $S/veach-mis.pbrt --strategy bsdf",
                  "14_mis $S/veach-mis.pbrt --heuristic balance",
                  "15_mis_ris $S/two-lights.pbrt --m 2", "16_lens_and_shutter $S/bokeh.pbrt --pixel centre",
                  "19_adaptive $S/cornell.pbrt --judge own --map b.pfm", "22_fast_bidirectional $S/cornell-spheres.pbrt --chances 4",
                  "21_bidirectional $S/cornell-spheres.pbrt --strategy 2,2",
                  "17_sky_image $S/sky.pbrt --compensation off", "18_dispersion $M/everything.pbrt", "18_dispersion $S/cornell-spheres.pbrt --threads 3",
                  "15_mis_ris $S/cornell.pbrt --max-depth 1", "07_path_tracing $S/cornell.pbrt --max-depth 0",
                  "21_bidirectional $S/cornell.pbrt --max-depth 3", "20_light_tracing $S/caustic.pbrt"):
        add(f"$B/{words} --size 24x16 --spp 6 --out a.pfm --out a.png --out a.ppm --stats a.json")
    add("$B/15_mis_ris $S/thousand-lights.pbrt --size 24x16 --spp 4 --threads 1 --out a.pfm --stats a.json")
    add("$B/11_light_importance $S/thousand-lights.pbrt --size 24x16 --spp 4 --threads 1 --out a.pfm")
    add("$B/12_ris $S/thousand-lights.pbrt --size 24x16 --spp 4 --threads 1 --out a.pfm")
    add("$B/10_cosine_sampling $S/knot.pbrt --size 24x16 --spp 2 --threads 2 --out a.pfm")
    add("$B/19_adaptive $S/high-contrast.pbrt --size 40x32 --spp 32 --threads 1 --out a.pfm --stats a.json")
    photons = ["23_photon_mapping", "24_progressive_photons", "25_vertex_merging"]
    for chapter in ["05_ray_casting"] + walks + photons:
        few = " --photons 2000" if chapter in photons[:2] else ""
        for words in ("--explain 12,9,1", "--explain-brightest --max-depth 2", "--split d"):
            add(f"$B/{chapter} $S/cornell-spheres.pbrt --size 24x16 --spp 4 {words}{few} --out a.pfm")
    for chapter in ("09_light_sampling", "15_mis_ris", "22_fast_bidirectional", "24_progressive_photons"):
        add(f"$B/{chapter} $S/cornell-spheres.pbrt --size 24x16 --spp 4 --paths 'L(S|D)?D*E' --out a.pfm")

    add("$B/21_bidirectional $S/cornell-spheres.pbrt --size 8x8 --spp 1 --pyramid b.png --out a.pfm --quiet")

    # Films, parts, and their sum.
    part = "$B/15_mis_ris $S/cornell-spheres.pbrt --size 24x16 --spp 10 --threads 1 --quiet"
    add(f"for k in 1 2 3; do {part} --part $k/3 --film $k.film --out $k.pfm; done;"
        " $B/merge a.film 3.film 1.film 2.film; $B/merge a.pfm 1.film 2.film --stats a.json; $B/merge b.pfm 1.film 1.film")
    add(f"{part} --film a.film --out a.pfm; {part} --film a.film --out b.pfm --spp 20; {part} --film a.film --seed 3;"
        " truncate -s 3000 a.film; $B/merge c.pfm a.film; rm -f *.film")

    # compare: noise, another mean, another place, pictures that do not fit.
    a = "$B/15_mis_ris $S/cornell.pbrt --size 32x32 --quiet --threads 1 --max-depth 5"
    add(f"{a} --spp 8 --out a.pfm --stats a.json; {a} --spp 8 --seed 1 --out b.pfm --stats b.json;"
        f" {a} --spp 8 --max-depth 1 --out c.pfm --stats c.json; {a} --spp 2 --size 16x16 --out d.pfm;"
        " $B/compare a.pfm b.pfm --out e.png; $B/compare c.pfm a.pfm --out f.pfm --range 0.5;"
        " $B/compare a.pfm a.pfm; $B/compare a.pfm d.pfm; $B/compare a.pfm b.pfm --trim 2; $B/compare a.pfm none.pfm")

    # Bad usage, bad input.
    for words in ("--help", "--spp 0", "--spp x", "--size 20", "--sise 2x2", "$S/none.pbrt", "--paths 'L('", "--part 4/3",
                  "--explain 900,1", "--out a.gif", "--seed -1", "--out /dev/full --size 8x8 --spp 1"):
        add(f"$B/10_cosine_sampling {words}")
    for words in ("--help", "", "a.ppm"):
        add(f"$B/compare {words}; $B/merge {words}; $B/26_radiosity {words or '--patches x'}")
    still = ("sed -e '/ActiveTransform/d; s/.spectrum eta. .glass.*/\"float eta\" 1.7/; s/.float shutter.*//;"
             " s/.float lensradius. [0-9.]*//; s/.float focaldistance. [0-9.]*//%s' $M/everything.pbrt >still.pbrt; ")
    add("for f in $T/*.pbrt; do $B/07_path_tracing $f --size 8x8 --spp 2 --threads 1 --out a.pfm; done")
    for chapter in walks + photons:
        smooth = "; s/.float roughness. [0-9.]*//" if chapter < "13" else ""
        no_points = "; /Source .point/d; /Source .distant/d" if chapter < "09" else ""
        scene = "$M/everything.pbrt" if chapter[:2] in ("18", "19") else "still.pbrt"
        add(still % (smooth + no_points) + f"$B/{chapter} {scene} --threads 1 --out a.pfm --stats a.json")
    return runs


def write_damaged_scenes(folder, tables):
    """Writes the input of the tables in tests/support/malformed as files: NNN.pbrt."""
    os.makedirs(folder, exist_ok=True)
    n = 0

    def put(name, text):
        with open(os.path.join(folder, name), "w") as file:
            file.write(text)

    for table in ("scenes.txt", "ply.txt"):
        lines, head = [], ""
        with open(os.path.join(tables, table)) as file:
            for line in file:
                if line.startswith("=>"):
                    if lines and table == "scenes.txt":
                        put(f"{n:03}.pbrt", head + "".join(lines))
                    elif lines:
                        put(f"{n:03}.ply", "".join(lines))
                        put(f"{n:03}.pbrt", f'Camera "perspective" WorldBegin\nShape "plymesh" "string filename" "{n:03}.ply"\n')
                    n, lines = n + 1, []
                elif line == "[world]\n":
                    head = 'Camera "perspective" WorldBegin\n'
                elif line.strip() and not line.startswith("##"):
                    lines.append(line)
