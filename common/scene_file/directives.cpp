#include "common/scene_file/directives.h"

#include "common/material/metal.h"
#include "common/scene_file/transforms.h"

Token expect_string(Lexer& lexer, const Token& word, const std::string& what) {
    Token token = lexer.next();
    if (token.type == Token::string) return token;
    fail(lexer.at(token),
         std::string(word.text) + " needs " + what + " in quotes, not " + Lexer::describe(token));
}

void Directives::move(Lexer& lexer, const Token& word) {
    TransformStep step = read_transform(lexer, word);
    if (step.replaces) state_.unusable = {};
    for (auto [is_set, t] :
         {std::pair(state_.set_start, &state_.start), std::pair(state_.set_end, &state_.end)}) {
        if (!is_set) continue;
        *t = step.replaces ? step.transform : *t * step.transform;
        std::string wrong = what_is_wrong_with(step, *t);
        if (wrong.empty()) continue;
        bool is_first = state_.unusable.empty();
        bool only_projects = what_is_wrong_with({step.transform}, *t).empty();
        if (is_first) state_.unusable = message_at(lexer.at(word), "error", wrong);
        state_.only_projects = only_projects && (is_first || state_.only_projects);
    }
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
    bool has_some = defaults != state_.defaults.end();
    Params params(lexer, word, notes_, true, has_some ? defaults->second : std::vector<Param>{});
    return params;
}

void Directives::coordinate_system(Lexer& lexer, const Token& word) {
    std::string name = lexer.unescape(expect_string(lexer, word, "a name"));
    if (!state_.unusable.empty()) throw InputError(state_.unusable);
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
    state_.unusable = {};
}

void Directives::color_space(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    if (token.text == "srgb") return;
    notes_.add(lexer.at(word), "ColorSpace " + quote(token.text) + " is read as \"srgb\"");
}

void Directives::make_named_medium(Lexer& lexer, const Token& word) {
    expect_string(lexer, word, "a name");
    Params params(lexer, word, notes_, false);
    notes_.need(params.at(), "a medium");
}

void Directives::medium_interface(Lexer& lexer, const Token& word) {
    bool is_empty = expect_string(lexer, word, "the name of a medium").text.empty();
    if (lexer.peek().type == Token::string) is_empty &= lexer.next().text.empty();
    if (!is_empty) notes_.need(lexer.at(word), "a medium");
}

void Directives::transform_times(Lexer& lexer, const Token& word) {
    double start = lexer.number(lexer.next(), "TransformTimes");
    double end = lexer.number(lexer.next(), "TransformTimes");
    if (start == 0 && end == 1) return;
    notes_.need(lexer.at(word), "TransformTimes other than 0 1");
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

void Directives::option(Lexer& lexer, const Token& word) {
    Token name = expect_string(lexer, word, "a name");
    Token value = lexer.next();
    if (value.type != Token::word && value.type != Token::string) {
        fail(lexer.at(value), "Option needs a value, not " + Lexer::describe(value));
    }
    notes_.add(lexer.at(name), "Option " + quote(lexer.unescape(name)) + " is ignored");
}

void Directives::setting(Lexer& lexer, const Token& word) {
    Params params(lexer, word, notes_);
    read_setting(std::string(word.text), params, scene_, notes_);
    if (word.text == "PixelFilter") has_filter_ = true;
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
        if (has_sky_image_) {
            params.stand_in(params.at(), "a second picture of the sky");
            params.ignore("string", {"filename"});
            if (!params.may_stand_in()) params.finish();
        } else {
            has_sky_image_ = true;  // also when it cannot be read: then it is not read again
            sky_image_ = read_sky_image(params, still_transform(params), files_);
            if (sky_image_) return;
        }
    }
    Light light = read_light(params, still_transform(params));
    if (!is_black(light.L)) scene_.lights.push_back(light);
}

void Directives::make_named_material(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    std::string name = lexer.unescape(token);
    Params params(lexer, word, notes_, false);
    params.read_type();
    bool is_used = named_materials_.contains(name);
    uint32_t index = find_material(name, lexer.at(token));
    NamedMaterial& named = named_materials_[name];
    if (named.defined) fail(lexer.at(token), "a second material " + quote(name));
    named.defined = true;
    std::optional<Material> material = read_material(params, textures_);
    if (!material && is_used) {
        fail(named.first_use, "the material " + quote(name) +
                                  ", of which shapes are left out, must be made before its use");
    }
    if (!material) absent_.insert(index);
    if (material) scene_.materials[index] = *material;
}

void Directives::material(Lexer& lexer, const Token& word) {
    Params params = read_params(lexer, word, "material");
    std::optional<Material> material = read_material(params, textures_);
    scene_.materials.push_back(material.value_or(Material{}));
    state_.material = static_cast<uint32_t>(scene_.materials.size() - 1);
    if (!material) absent_.insert(state_.material);
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
    Object& object = objects_[name];
    if (object.defined) fail(lexer.at(token), "a second object " + quote(name));
    begin(lexer, word);
    object.defined = true;
    open_object_ = &object;
}

void Directives::object_end(Lexer& lexer, const Token& word) {
    end(lexer, word);
    const Object& object = *open_object_;
    open_object_ = nullptr;
    for (const auto& [at, state] : object.early) place_object(object, at, state);
}

void Directives::object_instance(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    if (open_object_) fail(lexer.at(word), "ObjectInstance inside an object");
    Object& object = objects_[lexer.unescape(token)];
    if (object.defined) return place_object(object, lexer.at(word), state_);
    object.early.emplace_back(lexer.at(token), state_);
}

void Directives::place_object(const Object& object, const Position& at, const State& state) {
    for (const auto& [shape, inside] : object.shapes) {
        if (++placed_ > limits_.directives) {
            stop_reading(at, "more than " + std::to_string(limits_.directives) +
                                 " shapes of objects are placed");
        }
        Params params = shape;
        State where = inside;
        where.start = state.start * inside.start, where.end = state.end * inside.end;
        if (where.unusable.empty()) where.unusable = state.unusable;
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

// Whether a shape is not there: its material is that of a mere boundary, or its stand-in is
// nothing.
bool Directives::is_left_out(Params& params, const State& where) {
    if (absent_.contains(where.material)) return true;
    bool is_known = params.type() != "curve" && params.type() != "cylinder";
    if (!is_known && params.stands_in()) return true;
    for (const Param& param : params.all()) {
        bool is_clear = param.name == "alpha" && param.numbers == std::vector<double>{0};
        if (!is_clear || where.emission || !notes_.stand_ins()) continue;
        notes_.stand_in(param.at, "alpha");
        return true;
    }
    return false;
}

void Directives::place(Params& params, const State& where) {
    if (is_left_out(params, where)) return;
    if (!where.unusable.empty()) throw InputError(where.unusable);
    if (where.start != where.end && where.emission && notes_.stand_ins()) {
        notes_.stand_in(params.at(), "a light or camera that moves");
        State still = where;
        still.end = still.start;
        return place(params, still);
    }
    ShapeState state = {where.start, where.material, where.emission, where.reverse_orientation};
    state.primitives_elsewhere = moving_primitives_;
    state.vertices_elsewhere = moving_vertices_;
    if (where.start != where.end) return read_mover(params, where, state);
    read_shape(params, state, limits_, files_, scene_, notes_);
}

void Directives::texture(Lexer& lexer, const Token& word) {
    textures_.read(lexer, word, state_.defaults["texture"]);
}

void Directives::read_mover(Params& params, const State& where, ShapeState& state) {
    if (state.emission) {
        params.stand_in(params.at(), "a light or camera that moves");
    }
    constexpr size_t most = 1000;
    if (scene_.movers.size() == most) fail(params.at(), "more than 1000 shapes that move");
    Mover mover(where.start, where.end);
    mover.at = kept(params.at());
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
    bool is_direction = params.type() == "infinite" && state_.only_projects;
    if (!state_.unusable.empty() && !is_direction) throw InputError(state_.unusable);
    if (state_.start != state_.end) {
        params.stand_in(params.at(), "a light or camera that moves");
    }
    return state_.start;
}

// Names of objects and materials may be defined after their use, but must be defined.
void Directives::check_names() const {
    std::set<uint32_t> used;
    for (const Shape& shape : scene_.shapes) used.insert(shape.material);
    std::map<std::string, std::vector<std::string>> known;  // by kind
    std::map<Position, std::pair<std::string, std::string>> wrong;
    for (const auto& [name, object] : objects_) {
        if (object.defined) known["object"].push_back(name);
        if (!object.defined) wrong[object.early[0].first] = {"object", name};
    }
    for (const auto& [name, material] : named_materials_) {
        if (material.defined) known["NamedMaterial"].push_back(name);
        if (!material.defined && used.contains(material.index))
            wrong[material.first_use] = {"NamedMaterial", name};
    }
    std::vector<std::string> lines;
    for (const auto& [at, what] : wrong) {
        const auto& [kind, name] = what;
        lines.push_back(message_at(at, "error", unknown(kind, name, known[kind])));
    }
    if (!lines.empty()) throw InputError(join_lines(lines));
}

// A mesh may be given a material that is made later.
void Directives::check_uvs(const Geometry& g) {
    for (const Triangle& t : g.triangles) {
        uint32_t material = scene_.shapes[t.shape].material;
        if (scene_.materials[material].texture == 0) continue;
        if (!g.uvs.empty() && !std::isnan(g.uvs[t.v[0]].x)) continue;
        Material plain = scene_.materials[material];
        notes_.need(scene_.place(scene_.shapes[t.shape].at), "a textured mesh without usable uv");
        plain.reflectance = textures_.mean(plain.texture - 1u);
        if (plain.type == MaterialType::conductor) plain.k = k_of_reflectance(plain.reflectance);
        plain.texture = 0;
        scene_.shapes[t.shape].material = static_cast<uint32_t>(scene_.materials.size());
        scene_.materials.push_back(plain);
    }
}

// What pbrt renders without complaint, and we only with stand-ins.
void Directives::stand_in_for_missing() {
    Position file = scene_.place(nullptr);
    if (!has_camera_) {
        notes_.stand_in(file, "a scene without a camera");
        scene_.camera.right = {1, 0, 0}, scene_.camera.up = {0, 1, 0};
        scene_.camera.forward = {0, 0, 1};
        has_camera_ = true;
    }
    if (scene_.lights.empty() && !sky_image_) {
        notes_.stand_in(file, "a scene without light");
        Light sky;
        sky.type = LightType::infinite;
        sky.L = {0.5f, 0.5f, 0.5f};
        scene_.lights.push_back(sky);
    }
}

void Directives::check_complete() {
    const std::string unless_left_out = ", or all are left out as too small";
    Position file = scene_.place(nullptr);
    if (!saved_.empty()) fail(saved_.back().at, saved_.back().begin + " is never closed");
    check_names();
    check_uvs(scene_.geometry);
    for (const Mover& mover : scene_.movers) check_uvs(mover.geometry);
    if (!in_world_) fail(file, "no WorldBegin");
    if (notes_.stand_ins()) stand_in_for_missing();
    if (!has_camera_) fail(file, "no Camera");

    bool has_shape = scene_.geometry.size() > 0 || !scene_.movers.empty();
    if (!has_shape && notes_.stand_ins()) notes_.stand_in(file, "a scene without shapes");
    if (!has_shape && !notes_.stand_ins()) fail(file, "no Shape" + unless_left_out);
    if (scene_.lights.empty() && !sky_image_) fail(file, "no light" + unless_left_out);
}

Scene Directives::finish() {
    Position file = scene_.place(nullptr);
    check_complete();
    number_light_primitives(scene_);

    // Give the lights what pbrt's film does: twice the exposure is a picture twice as bright.
    float exposure = exposure_.shutter * exposure_.iso / 100;
    for (Light& light : scene_.lights) {
        light.L *= exposure;
        if (too_bright(light.L) || is_black(light.L))
            fail(file, "shutter or iso leave no usable light");
    }
    if (sky_image_) {
        for (Rgb& L : sky_image_->pixels) {
            L *= exposure;
            if (too_bright(L)) fail(file, "shutter or iso leave no usable light");
        }
        scene_.sky_image = std::make_shared<SkyImage>(std::move(*sky_image_));
    }
    if (!has_filter_) {
        notes_.add(file, "no PixelFilter: pbrt's \"gaussian\" is replaced by the box");
    }
    // Keep what textures need only if there are some.
    auto has_texture = [](const Material& m) { return m.texture != 0; };
    if (std::any_of(scene_.materials.begin(), scene_.materials.end(), has_texture)) {
        scene_.textures = std::make_shared<Textures>(textures_.take());
    } else {
        scene_.geometry.uvs = {};
    }
    return std::move(scene_);
}
