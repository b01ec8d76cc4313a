#include "common/scene_file/directives.h"

#include "common/scene_file/transforms.h"

Token expect_string(Lexer& lexer, const Token& word, const std::string& what) {
    Token token = lexer.next();
    if (token.type == Token::string) return token;
    fail(lexer.at(token),
         std::string(word.text) + " needs " + what + " in quotes, not " + Lexer::describe(token));
}

void Directives::move(Lexer& lexer, const Token& word) {
    Position at = lexer.at(word);
    TransformStep step = read_transform(lexer, word);
    if (state_.set_start) state_.start = apply(step, state_.start, at);
    if (state_.set_end) state_.end = apply(step, state_.end, at);
}

void Directives::active_transform(Lexer& lexer, const Token&) {
    Token which = lexer.next();
    bool all = which.text == "All", start = which.text == "StartTime";
    if (which.type != Token::word || !(all || start || which.text == "EndTime")) {
        fail(lexer.at(which),
             "ActiveTransform needs All, StartTime or EndTime, not " + Lexer::describe(which));
    }
    state_.set_start = all || start;
    state_.set_end = all || !start;
}

// What the parameters are for must be known, and no more: which of them a directive knows shows
// when it stands there.
void Directives::attribute(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "what it is for");
    std::string target(token.text);
    Params params(lexer, word, notes_, false);
    const std::vector<std::string> known = {"light", "material", "medium", "shape", "texture"};
    if (std::find(known.begin(), known.end(), target) == known.end()) {
        fail_unknown(lexer.at(token), "Attribute", target, known);
    }
    constexpr size_t most = 100;
    std::vector<Param>& defaults = state_.defaults[target];
    for (const Param& param : params.all()) {
        std::erase_if(defaults, [&](const Param& other) { return other.name == param.name; });
        if (defaults.size() == most) fail(param.at, "more than 100 attributes of " + quote(target));
        defaults.push_back(param);
    }
}

Params Directives::read_params(Lexer& lexer, const Token& word, const std::string& target) {
    auto defaults = state_.defaults.find(target);
    if (defaults == state_.defaults.end()) return Params(lexer, word, notes_);
    return Params(lexer, word, notes_, true, defaults->second);
}

void Directives::coordinate_system(Lexer& lexer, const Token& word) {
    std::string name = lexer.unescape(expect_string(lexer, word, "a name"));
    coordinate_systems_[name] = {state_.start, state_.end};
}

void Directives::coord_sys_transform(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    auto found = coordinate_systems_.find(lexer.unescape(token));
    if (found == coordinate_systems_.end()) {
        std::vector<std::string> known;
        for (const auto& [name, transforms] : coordinate_systems_) known.push_back(name);
        fail_unknown(lexer.at(token), "coordinate system", lexer.unescape(token), known);
    }
    std::tie(state_.start, state_.end) = found->second;
}

void Directives::color_space(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    if (token.text == "srgb") return;
    for (const char* name : {"aces2065-1", "dci-p3", "rec2020"}) {
        if (token.text != name) continue;
        notes_.add(lexer.at(word), "ColorSpace " + quote(name) + " is read as \"srgb\"");
        return;
    }
    fail_unknown(lexer.at(token), "ColorSpace", std::string(token.text),
                 {"aces2065-1", "dci-p3", "rec2020", "srgb"});
}

void Directives::accelerator(Lexer& lexer, const Token& word) {
    Params params(lexer, word, notes_);
    read_accelerator(params, notes_);
}

void Directives::camera(Lexer& lexer, const Token& word) {
    Params params(lexer, word, notes_);
    const Transform& camera_from_world = still_transform(params);
    read_camera(params, camera_from_world, scene_.camera, exposure_);
    has_camera_ = true;
    Transform world_from_camera = inverse(camera_from_world);
    coordinate_systems_["camera"] = {world_from_camera, world_from_camera};
}

void Directives::film(Lexer& lexer, const Token& word) {
    Params params(lexer, word, notes_);
    read_film(params, scene_, exposure_, notes_);
}

void Directives::integrator(Lexer& lexer, const Token& word) {
    Params params(lexer, word, notes_);
    read_integrator(params, scene_, notes_);
}

void Directives::option(Lexer& lexer, const Token& word) {
    Token name = expect_string(lexer, word, "a name");
    Token value = lexer.next();
    if (value.type != Token::word && value.type != Token::string) {
        fail(lexer.at(value), "Option needs a value, not " + Lexer::describe(value));
    }
    read_option(lexer.at(name), lexer.unescape(name), notes_);
}

void Directives::pixel_filter(Lexer& lexer, const Token& word) {
    Params params(lexer, word, notes_);
    read_pixel_filter(params, notes_);
    has_filter_ = true;
}

void Directives::sampler(Lexer& lexer, const Token& word) {
    Params params(lexer, word, notes_);
    read_sampler(params, scene_, notes_);
}

void Directives::world_begin(Lexer&, const Token&) {
    in_world_ = true;
    State fresh;
    fresh.defaults = std::move(state_.defaults);
    state_ = std::move(fresh);
    coordinate_systems_["world"] = {};
}

void Directives::area_light_source(Lexer& lexer, const Token& word) {
    Params params = read_params(lexer, word, "light");
    state_.emission = read_area_light(params);
}

void Directives::begin(Lexer& lexer, const Token& word) {
    constexpr size_t deepest = 1000;
    std::string name(word.text);
    if (saved_.size() == deepest) stop_reading(lexer.at(word), name + " more than 1000 deep");
    saved_.push_back({state_, lexer.at(word), name});
}

void Directives::end(Lexer& lexer, const Token& word) {
    std::string name(word.text);
    if (saved_.empty()) fail(lexer.at(word), name + " without a beginning");
    const SavedState& saved = saved_.back();
    if (saved.begin.front() != name.front()) {
        fail(lexer.at(word), name + " cannot close the " + saved.begin + " of line " +
                                 std::to_string(saved.at.line));
    }
    state_ = saved.state;
    saved_.pop_back();
}

void Directives::light_source(Lexer& lexer, const Token& word) {
    Params params = read_params(lexer, word, "light");
    if (params.type() == "infinite" && params.find("string", "filename")) {
        if (has_sky_image_) fail(params.at(), "a second picture of the sky");
        has_sky_image_ = true;  // also when it cannot be read: then it is not read again
        scene_.sky_image = read_sky_image(params, still_transform(params), files_);
        return;
    }
    Light light = read_light(params, still_transform(params));
    if (!is_black(light.L)) scene_.lights.push_back(light);
}

void Directives::make_named_material(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    std::string name = lexer.unescape(token);
    Params params(lexer, word, notes_, false);
    params.read_type();
    uint32_t index = find_material(name, lexer.at(token));
    NamedMaterial& named = named_materials_[name];
    if (named.defined) fail(lexer.at(token), "a second material " + quote(name));
    named.defined = true;
    scene_.materials[index] = read_material(params, textures_);
}

void Directives::material(Lexer& lexer, const Token& word) {
    Params params = read_params(lexer, word, "material");
    scene_.materials.push_back(read_material(params, textures_));
    state_.material = static_cast<uint32_t>(scene_.materials.size() - 1);
}

void Directives::named_material(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    state_.material = find_material(lexer.unescape(token), lexer.at(token));
}

void Directives::reverse_orientation(Lexer&, const Token&) {
    state_.reverse_orientation = !state_.reverse_orientation;
}

void Directives::object_begin(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    std::string name = lexer.unescape(token);
    if (open_object_) fail(lexer.at(word), "ObjectBegin inside an object");
    if (objects_.contains(name)) fail(lexer.at(token), "a second object " + quote(name));
    begin(lexer, word);
    open_object_ = &objects_[name];
}

void Directives::object_end(Lexer& lexer, const Token& word) {
    end(lexer, word);
    open_object_ = nullptr;
}

void Directives::object_instance(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    if (open_object_) fail(lexer.at(word), "ObjectInstance inside an object");
    auto found = objects_.find(lexer.unescape(token));
    if (found == objects_.end()) {
        std::vector<std::string> known;
        for (const auto& [name, object] : objects_) known.push_back(name);
        fail_unknown(lexer.at(token), "object", lexer.unescape(token), known);
    }
    for (const auto& [shape, state] : found->second.shapes) {
        if (++placed_ > limits_.directives) {
            stop_reading(lexer.at(word), "more than " + std::to_string(limits_.directives) +
                                             " shapes of objects are placed");
        }
        Params params = shape;
        State where = state;
        where.start = state_.start * state.start, where.end = state_.end * state.end;
        place(params, where);
    }
}

void Directives::shape(Lexer& lexer, const Token& word) {
    Params params = read_params(lexer, word, "shape");
    if (!open_object_) return place(params, state_);
    // Keep it for the instances.
    for (const Param& param : params.all()) object_numbers_ += param.numbers.size();
    if (object_numbers_ > 8 * limits_.vertices) {
        stop_reading(params.at(),
                     "objects of more than " + std::to_string(8 * limits_.vertices) + " numbers");
    }
    open_object_->shapes.emplace_back(params, state_);
    State& kept = open_object_->shapes.back().second;
    kept.defaults.clear();
    if (kept.emission) notes_.add(params.at(), "lights inside an object are left out, as in pbrt");
    kept.emission = {};
}

void Directives::place(Params& params, const State& where) {
    ShapeState state = {where.start, where.material, where.emission, where.reverse_orientation};
    state.primitives_elsewhere = moving_primitives_;
    state.vertices_elsewhere = moving_vertices_;
    size_t before = scene_.geometry.size() + moving_primitives_;
    if (where.start == where.end) {
        read_shape(params, state, limits_, files_, scene_, notes_);
    } else {
        read_mover(params, where, state);
    }
    if (scene_.geometry.size() + moving_primitives_ > before) return;
    if (!too_small_) too_small_ = params.at();
    if (!too_small_light_ && where.emission) too_small_light_ = params.at();
}

void Directives::texture(Lexer& lexer, const Token& word) { textures_.read(lexer, word, notes_); }

uint64_t Directives::bytes() const {
    uint64_t sum = scene_.shapes.size() * sizeof(Shape) + scene_.lights.size() * sizeof(Light) +
                   scene_.materials.size() * sizeof(Material);
    auto add = [&](const Geometry& g) {
        sum += (g.positions.size() + g.normals.size()) * sizeof(Vec3) +
               g.uvs.size() * sizeof(Vec2) + g.triangles.size() * sizeof(Triangle) +
               g.spheres.size() * sizeof(Sphere) + g.disks.size() * sizeof(Disk);
    };
    add(scene_.geometry);
    for (const Mover& mover : scene_.movers) add(mover.geometry);
    if (scene_.sky_image) sum += scene_.sky_image->pixels.size() * sizeof(Rgb);
    for (const TexturePicture& picture : textures_.textures().pictures) {
        sum += picture.texels.size() * sizeof(Rgb);
    }
    return sum;
}

void Directives::read_mover(Params& params, const State& where, ShapeState& state) {
    if (state.emission) params.not_supported(params.at(), "a shape that moves cannot shine");
    constexpr size_t most = 1000;
    if (scene_.movers.size() == most) fail(params.at(), "more than 1000 shapes that move");
    Mover mover(where.start, where.end);
    mover.line = params.at().line, mover.column = params.at().column;
    state.primitives_elsewhere += scene_.geometry.size();
    state.vertices_elsewhere += scene_.geometry.positions.size();

    std::swap(scene_.geometry, mover.geometry);
    read_shape(params, state, limits_, files_, scene_, notes_);
    std::swap(scene_.geometry, mover.geometry);
    if (mover.geometry.size() == 0) return;
    moving_primitives_ += mover.geometry.size();
    moving_vertices_ += mover.geometry.positions.size();
    scene_.movers.push_back(std::move(mover));
}

// The number of the named material, which may be defined after its use.
uint32_t Directives::find_material(const std::string& name, const Position& at) {
    auto [place, is_new] = named_materials_.try_emplace(name);
    if (is_new) {
        place->second = {static_cast<uint32_t>(scene_.materials.size()), false, at};
        scene_.materials.emplace_back();
    }
    return place->second.index;
}

// The current transform; not supported where it moves while the shutter is open.
const Transform& Directives::still_transform(Params& params) const {
    if (state_.start != state_.end) {
        params.not_supported(params.at(), "only shapes can move");
    }
    return state_.start;
}

void Directives::check_materials() const {
    std::vector<std::string> known;
    std::map<uint32_t, const std::string*> undefined;  // by index, which is the order of first use
    for (const auto& [name, material] : named_materials_) {
        if (material.defined) known.push_back(name);
        if (!material.defined) undefined[material.index] = &name;
    }
    std::vector<std::string> wrong;
    for (const auto& [index, name] : undefined) {
        if (wrong.size() == most_errors) {
            wrong.push_back(message_at({scene_.file}, "error", too_much_is_wrong));
            break;
        }
        wrong.push_back(message_at(named_materials_.at(*name).first_use, "error",
                                   unknown("NamedMaterial", *name, known)));
    }
    if (!wrong.empty()) throw InputError(join_lines(wrong));
}

// A mesh may be given a material whose texture is named later.
void Directives::check_uvs(const Geometry& g) const {
    for (const Triangle& t : g.triangles) {
        uint32_t material = scene_.shapes[t.shape].material;
        if (scene_.materials[material].texture == 0) continue;
        if (!g.uvs.empty() && !std::isnan(g.uvs[t.v[0]].x)) continue;
        for (const auto& [name, named] : named_materials_) {
            if (named.index != material) continue;
            fail(named.first_use, "a mesh of material " + quote(name) +
                                      " has no usable uv, which its texture needs");
        }
    }
}

void Directives::check_complete() const {
    Position file = {scene_.file};
    if (!saved_.empty()) fail(saved_.back().at, saved_.back().begin + " is never closed");
    check_materials();
    check_uvs(scene_.geometry);
    for (const Mover& mover : scene_.movers) check_uvs(mover.geometry);
    if (!in_world_) fail(file, "no WorldBegin");
    if (!has_camera_) fail(file, "no Camera");

    // Where something is missing, it may be what was too small to keep.
    const std::string too_small = std::string(": all triangles of this Shape are too small ") +
                                  "(areas of 0, or below 5e-20: choose a smaller unit)";
    bool has_shape = scene_.geometry.size() > 0 || !scene_.movers.empty();
    bool has_light = !scene_.lights.empty() || scene_.sky_image;
    if (!has_shape && too_small_) fail(*too_small_, "no Shape is left" + too_small);
    if (!has_shape) fail(file, "no Shape");
    if (!has_light && too_small_light_) fail(*too_small_light_, "no light is left" + too_small);
    if (!has_light) fail(file, "no light: the picture would be black");
}

Scene Directives::finish() {
    Position file = {scene_.file};
    check_complete();
    number_light_primitives(scene_);

    // Give the lights what pbrt's film does: twice the exposure is a picture twice as bright.
    float exposure = exposure_.shutter * exposure_.iso / 100;
    for (Light& light : scene_.lights) {
        light.L *= exposure;
        if (too_bright(light.L) || is_black(light.L))
            fail(file, "shutter or iso leave no usable light");
    }
    if (scene_.sky_image)
        for (Rgb& L : scene_.sky_image->pixels) {
            L *= exposure;
            if (too_bright(L)) fail(file, "shutter or iso leave no usable light");
        }
    if (!has_filter_) {
        notes_.add(file, "no PixelFilter: pbrt's \"gaussian\" is replaced by the box");
    }
    // Keep what textures need only if there are some.
    auto has_texture = [](const Material& m) { return m.texture != 0; };
    if (std::any_of(scene_.materials.begin(), scene_.materials.end(), has_texture)) {
        scene_.textures = textures_.take();
    } else {
        scene_.geometry.uvs = {};
    }
    return std::move(scene_);
}
