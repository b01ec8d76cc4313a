# Builds a scene of build/flatten in Blender, renders it with Cycles, and writes a PFM:
#   blender -b --factory-startup -P cycles.py -- SCENE.json OUT.pfm WIDTH HEIGHT SPP DEPTH SEED THREADS
import array
import json
import math
import sys

import bmesh
import bpy
from mathutils import Matrix, Vector

name, out, *numbers = sys.argv[sys.argv.index("--") + 1:]
width, height, spp, depth, seed, threads = map(int, numbers)
flat = json.load(open(name))
scene = bpy.context.scene
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)


def add(name, data, matrix=None):
    thing = bpy.data.objects.new(name, data)
    thing.matrix_world = matrix or Matrix()
    scene.collection.objects.link(thing)
    return thing


def metal(cos, eta, k):
    """The Fresnel reflectance of a metal: the mean of both polarizations."""
    sin2 = 1 - cos * cos
    t0 = eta * eta - k * k - sin2
    a2b2 = math.sqrt(t0 * t0 + 4 * eta * eta * k * k)
    a = math.sqrt(max(0, (a2b2 + t0) / 2))
    s = (a2b2 + cos * cos - 2 * a * cos) / (a2b2 + cos * cos + 2 * a * cos)
    t = cos * cos * a2b2 + sin2 * sin2
    u = 2 * a * cos * sin2
    return s * (1 + (t - u) / (t + u)) / 2


def inside_glass(p):
    """eta^2 of the glass balls around p: light that leaves glass loses this factor, but not in Cycles."""
    factor = 1
    for s in flat["spheres"]:
        shape = flat["shapes"][s["shape"]]
        m = flat["materials"][shape["material"]]
        if m["type"] == "dielectric" and (Vector(p) - Vector(s["c"])).length < s["r"]:
            factor *= m["ior"] ** (-2 if shape["inward"] else 2)
    return factor


def surface(shape, at):
    """The material of a shape, and the light that it sends out."""
    m = flat["materials"][shape["material"]]
    made = bpy.data.materials.new("m")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    end = nodes.new("ShaderNodeOutputMaterial").inputs[0]
    geometry = nodes.new("ShaderNodeNewGeometry")
    if m["type"] == "diffuse":
        bsdf = nodes.new("ShaderNodeBsdfDiffuse")
        bsdf.inputs["Color"].default_value = m["reflectance"] + [1]
    elif m["type"] == "dielectric":
        bsdf = nodes.new("ShaderNodeBsdfGlass")
        bsdf.distribution = "SHARP"
        bsdf.inputs["IOR"].default_value = m["ior"]
    else:
        bsdf = nodes.new("ShaderNodeBsdfGlossy")
        bsdf.distribution = "GGX" if m["alpha"] > 0 else "SHARP"
        bsdf.inputs["Roughness"].default_value = math.sqrt(m["alpha"])
        cos = nodes.new("ShaderNodeVectorMath")
        cos.operation = "DOT_PRODUCT"
        links.new(geometry.outputs["Incoming"], cos.inputs[0])
        links.new(geometry.outputs["Normal"], cos.inputs[1])
        ramp = nodes.new("ShaderNodeValToRGB")
        stops = ramp.color_ramp.elements
        for i in range(32):
            x = i / 31
            stop = stops[0] if i == 0 else stops[-1] if i == 31 else stops.new(x)
            stop.position = x
            stop.color = [metal(x, *both) for both in zip(m["eta"], m["k"])] + [1]
        links.new(cos.outputs["Value"], ramp.inputs[0])
        links.new(ramp.outputs[0], bsdf.inputs["Color"])
    links.new(bsdf.outputs[0], end)
    if shape["light"] >= 0:
        light = flat["lights"][shape["light"]]
        emission = nodes.new("ShaderNodeEmission")
        strength = max(light["L"]) / inside_glass(at)
        emission.inputs["Color"].default_value = [x / max(light["L"]) for x in light["L"]] + [1]
        emission.inputs["Strength"].default_value = strength
        if not light["two_sided"]:
            front = nodes.new("ShaderNodeMath")
            front.operation = "MULTIPLY_ADD"
            front.inputs[1].default_value = -strength
            front.inputs[2].default_value = strength
            links.new(geometry.outputs["Backfacing"], front.inputs[0])
            links.new(front.outputs[0], emission.inputs["Strength"])
        both = nodes.new("ShaderNodeAddShader")
        links.new(bsdf.outputs[0], both.inputs[0])
        links.new(emission.outputs[0], both.inputs[1])
        links.new(both.outputs[0], end)
    return made


def add_mesh(shape, positions, faces, normals=None):
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata(positions, [], faces)
    mesh.materials.append(surface(flat["shapes"][shape], sum(map(Vector, positions), Vector()) / len(positions)))
    if normals:
        mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
        mesh.use_auto_smooth = True
        mesh.normals_split_custom_set_from_vertices(normals)
    add("mesh", mesh)


by_shape = {}
for a, b, c, shape in flat["triangles"]:
    by_shape.setdefault(shape, []).append((a, b, c))
for shape, faces in by_shape.items():
    used = sorted({v for face in faces for v in face})
    number = {v: i for i, v in enumerate(used)}
    normals = [flat["normals"][v] for v in used] if flat["normals"] else []
    smooth = any(any(n) for n in normals)
    add_mesh(shape, [flat["positions"][v] for v in used], [[number[v] for v in face] for face in faces],
             normals if smooth else None)

for s in flat["spheres"]:  # as many triangles, with the area of the sphere; Cycles has no spheres
    shape = flat["shapes"][s["shape"]]
    ball = bmesh.new()
    bmesh.ops.create_icosphere(ball, subdivisions=4 if shape["light"] >= 0 else 6, radius=1)
    r = s["r"] * math.sqrt(4 * math.pi / sum(face.calc_area() for face in ball.faces))
    sign = -1 if shape["inward"] else 1
    positions = [Vector(s["c"]) + r * v.co for v in ball.verts]
    faces = [[v.index for v in face.verts][::sign] for face in ball.faces]
    add_mesh(s["shape"], positions, faces, [sign * v.co for v in ball.verts])

sky = sum((Vector(light["L"]) for light in flat["lights"] if light["type"] == "infinite"), Vector())
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = list(sky) + [1]

# pbrt's camera may be left-handed, and Blender's is not: such a picture is rendered mirrored.
camera = flat["camera"]
right, up, forward = (Vector(camera[axis]).normalized() for axis in ("right", "up", "forward"))
mirrored = right.cross(up).dot(forward) > 0
data = bpy.data.cameras.new("camera")
data.sensor_fit = "VERTICAL" if width > height else "HORIZONTAL"
data.angle = math.radians(camera["fov"])
data.clip_start, data.clip_end = 1e-4, 1e6
if camera["lens"] > 0:
    data.dof.use_dof, data.dof.focus_distance = True, camera["focus"]
    data.dof.aperture_fstop = data.lens * 1e-3 / (2 * camera["lens"])
matrix = Matrix((-right if mirrored else right, up, -forward)).transposed().to_4x4()
scene.camera = add("camera", data, Matrix.Translation(camera["o"]) @ matrix)

scene.render.engine = "CYCLES"
cycles = scene.cycles
cycles.device, cycles.samples, cycles.seed = "CPU", spp, seed
cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = depth - 1
cycles.caustics_reflective = cycles.caustics_refractive = True
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
cycles.light_sampling_threshold = 0
cycles.pixel_filter_type = "BOX"
render = scene.render
render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
render.threads_mode, render.threads = "FIXED", threads
render.film_transparent = render.use_compositing = render.use_sequencer = False
render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
render.filepath = out + ".exr"
bpy.ops.render.render(write_still=True)

image = bpy.data.images.load(render.filepath)
image.colorspace_settings.name = "Non-Color"
pixels = array.array("f", image.pixels[:])
with open(out, "wb") as file:
    file.write(b"PF\n%d %d\n-1.0\n" % (width, height))
    for y in range(height):
        row = [pixels[4 * (y * width + x):4 * (y * width + x) + 3] for x in range(width)]
        for pixel in reversed(row) if mirrored else row:
            file.write(pixel.tobytes())
