#include "common/scene_file/reader.h"

#include <algorithm>
#include <utility>

#include "common/base/text.h"
#include "common/material/hit.h"
#include "common/scene/mover.h"
#include "common/scene_file/lights.h"
#include "common/scene_file/settings.h"
#include "common/scene_file/shapes.h"

namespace {

constexpr const char* moving_light = "a light or camera that moves";

/// Reads directive by directive, in one file and in all that it includes, and keeps what holds for
/// what comes next. What is wrong with one directive does not keep it from reading the next.
class Reader {
public:
    explicit Reader(Input& input) : input_(input) {
        scene_.materials.emplace_back();  // of shapes that are given none
    }

    Scene read_scene(std::string text) {
        try {
            input_.add_file(input_.main_file, text);
            read(input_.main_file, std::move(text));
            // What is missing may be in what could not be used.
            if (input_.errors() == 0) finish();
        } catch (const InputError& error) {
            input_.add(error);
        } catch (const ReadingEnds& end) {
            input_.add(end);
        }
        scene_.origin = std::make_shared<Origin>(input_.finish());
        return std::move(scene_);
    }

private:
    enum class Block { options, world, both };
    struct Directives {
        const char* names;
        Block block;  // where they may stand
        void (Reader::*read)();
    };

    static const std::map<std::string, const Directives*>& known_directives() {
        using R = Reader;
        static constexpr Directives rows[] = {
            {"Film Integrator PixelFilter Sampler", Block::options, &R::setting},
            {"ActiveTransform", Block::both, &R::active_transform},
            {"AreaLightSource", Block::world, &R::area_light_source},
            {"Accelerator ColorSpace MakeNamedMedium MediumInterface Option TransformTimes",
             Block::both, &R::unsupported},
            {"Attribute", Block::both, &R::attribute},
            {"AttributeBegin TransformBegin", Block::world, &R::begin},
            {"AttributeEnd TransformEnd", Block::world, &R::end},
            {"Camera", Block::options, &R::camera},
            {"CoordSysTransform", Block::both, &R::coord_sys_transform},
            {"CoordinateSystem", Block::both, &R::coordinate_system},
            {"Identity Translate Scale Rotate LookAt Transform ConcatTransform", Block::both,
             &R::move},
            {"Import", Block::world, &R::include},
            {"Include", Block::both, &R::include},
            {"LightSource", Block::world, &R::light_source},
            {"MakeNamedMaterial", Block::world, &R::make_named_material},
            {"Material", Block::world, &R::material},
            {"NamedMaterial", Block::world, &R::named_material},
            {"ObjectBegin", Block::world, &R::object_begin},
            {"ObjectEnd", Block::world, &R::object_end},
            {"ObjectInstance", Block::world, &R::object_instance},
            {"ReverseOrientation", Block::world, &R::reverse_orientation},
            {"Shape", Block::world, &R::shape},
            {"Texture", Block::world, &R::texture},
            {"WorldBegin", Block::options, &R::world_begin},
        };
        static const auto known = [] {
            std::map<std::string, const Directives*> map;
            for (const Directives& row : rows) {
                for (const std::string& name : words_of(row.names)) map[name] = &row;
            }
            return map;
        }();
        return known;
    }

    void read(const std::string& path, std::string text) {
        constexpr size_t most_errors = 20;
        Lexer lexer(path, std::move(text), input_.report);
        Lexer* outer = std::exchange(lexer_, &lexer);
        open_files_.push_back(canonical(path));
        while (lexer.peek().type != Token::end) {
            try {
                read_directive(lexer.next());
            } catch (const InputError& error) {
                input_.add(error);
                skip_arguments();
            }
            if (input_.errors() < most_errors) continue;
            stop_reading({input_.main_file}, "so much is wrong that the rest is not read");
        }
        open_files_.pop_back();
        lexer_ = outer;
    }

    // Reads over what is left of a directive.
    void skip_arguments() {
        while (lexer_->has_argument()) lexer_->next();
    }

    void read_directive(const Token& word) {
        at_ = lexer_->at(word);
        check_limit(at_, ++directives_read_, input_.limits.directives, "directives");
        if (word.type != Token::word || to_number(word.text)) {
            lexer_->fail_at(word, "expected a directive");
        }
        name_ = word.text;
        auto [names, block, read] = *look_up(known_directives(), name_, "directive", at_);
        if (name_ == "WorldBegin" && in_world_) fail(at_, "a second WorldBegin");
        if (block == (in_world_ ? Block::options : Block::world)) {
            fail(at_, name_ + " must stand " + (in_world_ ? "before" : "after") + " WorldBegin");
        }
        if (block == Block::options && !options_read_.insert(name_).second) {
            input_.note(at_, "a second " + name_ + ": the last one counts");
        }
        (this->*read)();
    }

    // Those of the directive, and of Attribute for what it makes.
    Params params(const std::string& what = "medium") {
        return Params(*lexer_, name_, at_, input_, state_.defaults[what]);
    }
    // The name in quotes behind the directive.
    std::string name() {
        return lexer_->unescape(lexer_->expect(Token::string, name_ + " needs a name in quotes"));
    }

    void include() {
        bool is_import = name_ == "Import";
        Position at = at_;
        std::string path = input_.find(at, name()), file = canonical(path), text;
        if (std::find(open_files_.begin(), open_files_.end(), file) != open_files_.end()) {
            fail(at, quote_file(path) + " includes itself");
        }
        check_limit(at, open_files_.size(), 100, "files include each other");
        check_limit(at, ++includes_, 10000, "files are included");
        if (!input_.try_to_read(at, "a scene file that cannot be read",
                                [&] { text = input_.read(path, at); })) {
            return;
        }
        if (!is_import) return read(path, std::move(text));
        // What Import changes, it changes for the file alone.
        begin();
        read(path, std::move(text));
        name_ = "Import";
        at_ = at;
        end();
    }

    void move() {
        Transform step = read_transform(*lexer_, name_);
        bool replaces = name_ == "Identity" || name_ == "Transform";
        if (replaces) state_.unusable.clear();
        for (auto [is_set, t] :
             {std::pair(state_.set_start, &state_.start), std::pair(state_.set_end, &state_.end)}) {
            if (!is_set) continue;
            *t = replaces ? step : *t * step;
            if (is_usable(*t) || !state_.unusable.empty()) continue;
            state_.unusable = message_at(
                at_, "error", "the transform has no inverse, projects, or is too large or small");
        }
    }

    void active_transform() {
        Token which = lexer_->next();
        if (which.text != "All" && which.text != "StartTime" && which.text != "EndTime") {
            lexer_->fail_at(which, "ActiveTransform needs All, StartTime or EndTime");
        }
        state_.set_start = which.text != "EndTime";
        state_.set_end = which.text != "StartTime";
    }

    void attribute() {
        std::string what = name();
        look_up(state_.defaults, what, "Attribute", at_);
        std::vector<Param>& defaults = state_.defaults[what];
        while (lexer_->peek().type == Token::string) {
            check_limit(at_, defaults.size() + 1, 100, "attributes");
            defaults.push_back(read_param(*lexer_));
            defaults.back().is_default = true;
        }
    }

    void coordinate_system() {
        std::string own = name();
        if (!state_.unusable.empty()) throw InputError(state_.unusable);
        coordinate_systems_[own] = {state_.start, state_.end};
    }

    void coord_sys_transform() {
        std::tie(state_.start, state_.end) =
            look_up(coordinate_systems_, name(), "coordinate system", at_);
        state_.unusable = {};
    }

    void unsupported() {
        skip_arguments();
        if (or_stand_in(name_).empty()) return input_.note(at_, name_ + " is ignored");
        input_.stand_in(at_, name_);
    }

    void camera() {
        Params read = params();
        Transform camera_from_world = still_transform(read);
        scene_.camera = read_camera(read, camera_from_world);
        Transform world_from_camera = inverse(camera_from_world);
        coordinate_systems_["camera"] = {world_from_camera, world_from_camera};
    }

    void setting() { read_setting(name_, params(), scene_, iso_); }

    void world_begin() {
        in_world_ = true;
        State fresh;
        fresh.defaults = std::move(state_.defaults);
        state_ = std::move(fresh);
        coordinate_systems_["world"] = {};
    }

    void area_light_source() { state_.emission = read_area_light(params("light")); }

    void begin() {
        check_limit(at_, saved_.size() + 1, 1000, "blocks in each other");
        saved_.push_back(state_);
        state_.begin = name_;
        state_.at = at_;
    }

    void end() {
        if (saved_.empty()) fail(at_, name_ + " without a beginning");
        if (state_.begin.front() != name_.front()) {
            fail(at_, name_ + " cannot close the " + state_.begin + " of line " +
                          std::to_string(state_.at.line));
        }
        state_ = saved_.back();
        saved_.pop_back();
    }

    void light_source() {
        Params read = params("light");
        bool is_sky = read.type() == "infinite", is_picture = read.find("filename");
        // A sky of one color is the same wherever it stands.
        Transform place = is_sky && !is_picture ? Transform{} : still_transform(read);
        if (is_picture && has_sky_image_) {
            input_.stand_in(at_, "a second picture of the sky");
        } else if (is_picture) {
            has_sky_image_ = true;  // also when it cannot be read: then it is not read again
            sky_image_ = read_sky_image(read, place);
            if (sky_image_) return;
        }
        Light light = read_light(read, place);
        if (!is_black(light.L)) scene_.lights.push_back(light);
    }

    void make_named_material() {
        std::string own = name();
        Params read = params();
        bool is_used = unmade_.erase(own) > 0;
        if (!is_used && named_materials_.contains(own)) {
            fail(at_, "a second material " + quote(own));
        }
        uint32_t number = number_of_material(own);
        std::optional<Material> material = read_material(read, textures_);
        if (material) scene_.materials[number] = *material;
        if (!material) absent_.insert(number);
        if (!material && is_used) {
            fail(at_, "a material of shapes that are left out must be made before its use");
        }
    }

    void material() {
        std::optional<Material> material = read_material(params("material"), textures_);
        scene_.materials.push_back(material.value_or(Material{}));
        state_.material = static_cast<uint32_t>(scene_.materials.size() - 1);
        if (!material) absent_.insert(state_.material);
    }

    void named_material() {
        std::string own = name();
        if (!named_materials_.contains(own)) unmade_[own] = at_;
        state_.material = number_of_material(own);
    }

    // Of the material of this name, which may be made later.
    uint32_t number_of_material(const std::string& own) {
        uint32_t next = static_cast<uint32_t>(scene_.materials.size());
        auto [place, is_new] = named_materials_.try_emplace(own, next);
        if (is_new) scene_.materials.emplace_back();
        return place->second;
    }

    void reverse_orientation() { state_.reverse_orientation = !state_.reverse_orientation; }

    void object_begin() {
        std::string own = name();
        if (open_object_) fail(at_, "ObjectBegin inside an object");
        if (objects_.contains(own)) fail(at_, "a second object " + quote(own));
        begin();
        open_object_ = &objects_[own];
    }

    void object_end() {
        end();
        open_object_ = nullptr;
    }

    // They are placed when all objects are known.
    void object_instance() {
        std::string own = name();
        if (open_object_) fail(at_, "ObjectInstance inside an object");
        instances_.push_back({own, state_});
        instances_.back().second.at = at_;
    }

    void place_instances() {
        for (const auto& [object, state] : instances_) {
            for (const auto& [shape, inside] : look_up(objects_, object, "object", state.at)) {
                check_limit(state.at, ++placed_, input_.limits.directives,
                            "shapes of objects are placed");
                State where = inside;
                where.start = state.start * inside.start;
                where.end = state.end * inside.end;
                if (where.unusable.empty()) where.unusable = state.unusable;
                place(shape, where);
            }
        }
    }

    void shape() {
        Params read = params("shape");
        if (!open_object_) return place(read, state_);
        // Keep it for the instances.
        open_object_->push_back({read, state_});
        State& kept = open_object_->back().second;
        kept.defaults.clear();
        if (kept.emission) input_.note(at_, "lights inside an object are left out, as in pbrt");
        kept.emission = {};
    }

    void place(const Params& params, State where) {
        const Param* alpha = params.find("alpha");
        bool is_clear = alpha && alpha->numbers == std::vector<double>{0} && !where.emission;
        bool is_nothing = params.stands_in() && params.type() != "loopsubdiv";
        if (absent_.contains(where.material) || is_nothing || is_clear) return;
        if (!where.unusable.empty()) throw InputError(where.unusable);
        bool moves = where.start != where.end;
        if (moves && where.emission) {
            input_.stand_in(params.at(), moving_light);
            moves = false;
        }
        std::optional<Mover> mover;
        if (moves) {
            check_limit(params.at(), scene_.movers.size() + 1, 1000, "shapes that move");
            mover.emplace(where.start, where.end);
            mover->at = kept(params.at());
            std::swap(scene_.geometry, mover->geometry);
        }
        size_t primitives = scene_.geometry.size(), vertices = scene_.geometry.positions.size();
        read_shape(params, where, scene_);
        primitives_ += scene_.geometry.size() - primitives;
        vertices_ += scene_.geometry.positions.size() - vertices;
        check_limit(params.at(), primitives_, input_.limits.primitives,
                    "triangles, spheres and disks");
        check_limit(params.at(), vertices_, input_.limits.vertices, "vertices");
        if (!mover) return;
        std::swap(scene_.geometry, mover->geometry);
        if (mover->geometry.size() > 0) scene_.movers.push_back(std::move(*mover));
    }

    void texture() { textures_.read(*lexer_, at_, input_, state_.defaults["texture"]); }

    // The current transform; not supported where it moves while the shutter is open.
    Transform still_transform(const Params& params) {
        if (!state_.unusable.empty()) throw InputError(state_.unusable);
        if (state_.start != state_.end) input_.stand_in(params.at(), moving_light);
        return state_.start;
    }

    // A mesh may be given a material that is made later.
    void check_uvs(const Geometry& g) {
        for (const Triangle& t : g.triangles) {
            Shape& shape = scene_.shapes[t.shape];
            Material plain = scene_.materials[shape.material];
            bool has_uv = !g.uvs.empty() && !std::isnan(g.uvs[t.v[0]].x);
            if (plain.texture == 0 || has_uv) continue;
            input_.stand_in(*shape.at, "a textured mesh without usable uv");
            plain.reflectance = textures_.mean(plain.texture - 1u);
            if (plain.type == MaterialType::conductor) {
                plain.k = k_of_reflectance(plain.reflectance);
            }
            plain.texture = 0;
            shape.material = static_cast<uint32_t>(scene_.materials.size());
            scene_.materials.push_back(plain);
        }
    }

    // pbrt renders what is missing without complaint, and we only with stand-ins.
    void check_complete() {
        Position file = {input_.main_file};
        if (!saved_.empty()) fail(state_.at, state_.begin + " is never closed");
        for (const auto& [name, at] : unmade_) named_materials_.erase(name);
        for (const auto& [name, at] : unmade_) {
            input_.error(at, unknown("material", name, names_of(named_materials_)));
        }
        place_instances();
        check_uvs(scene_.geometry);
        for (const Mover& mover : scene_.movers) check_uvs(mover.geometry);
        if (!in_world_) fail(file, "no WorldBegin");
        if (!options_read_.contains("Camera")) fail(file, "no Camera");
        if (scene_.geometry.size() == 0 && scene_.movers.empty()) {
            input_.stand_in(file, "a scene without shapes");
        }
        if (scene_.lights.empty() && !sky_image_) {
            input_.stand_in(file, "a scene without light");
            Light sky;
            sky.type = LightType::infinite;
            sky.L = {0.5f, 0.5f, 0.5f};
            scene_.lights.push_back(sky);
        }
    }

    // Gives each area light its range of primitives.
    void number_light_primitives() {
        auto shape_of = [](const auto& primitive) { return primitive.shape; };
        const Geometry& g = scene_.geometry;
        for (uint32_t prim = 0; prim < g.size(); prim++) {
            int index = scene_.shapes[visit(g, prim, shape_of, shape_of, shape_of)].light;
            if (index < 0) continue;
            Light& light = scene_.lights[static_cast<size_t>(index)];
            if (light.prims++ == 0) light.first_prim = prim;
        }
    }

    void finish() {
        Position file = {input_.main_file};
        check_complete();
        number_light_primitives();

        // Give the lights what pbrt's film does: twice the exposure is a picture twice as bright.
        const Camera& camera = scene_.camera;
        float exposure = (camera.shutter_close - camera.shutter_open) * iso_ / 100;
        bool usable = true;
        auto expose = [&](Rgb& L) {
            L *= exposure;
            usable &= !too_bright(L);
        };
        for (Light& light : scene_.lights) {
            expose(light.L);
            usable &= !is_black(light.L);
        }
        if (sky_image_) {
            for (Rgb& L : sky_image_->pixels) expose(L);
            scene_.sky_image = std::make_shared<SkyImage>(std::move(*sky_image_));
        }
        if (!usable) fail(file, "shutter or iso leave no usable light");
        if (!options_read_.contains("PixelFilter")) {
            input_.note(file, "no PixelFilter: pbrt's \"gaussian\" is replaced by the box");
        }
        // Keep what textures need only if there are some.
        auto has_texture = [](const Material& m) { return m.texture != 0; };
        if (std::any_of(scene_.materials.begin(), scene_.materials.end(), has_texture)) {
            scene_.textures = std::make_shared<Textures>(textures_.take());
        } else {
            scene_.geometry.uvs = {};
        }
    }

    Input& input_;
    TextureReader textures_;
    Scene scene_;
    std::optional<SkyImage> sky_image_;
    float iso_ = 100;
    bool in_world_ = false, has_sky_image_ = false;

    Lexer* lexer_ = nullptr;               // of the innermost file
    std::string name_;                     // of the directive that is read
    Position at_;                          // where it stands
    std::vector<std::string> open_files_;  // by their canonical names
    std::set<std::string> options_read_;   // Camera and its like
    uint64_t directives_read_ = 0, includes_ = 0;

    State state_;
    std::vector<State> saved_;
    std::map<std::string, uint32_t> named_materials_;  // into Scene::materials
    std::map<std::string, Position> unmade_;           // those that are only used yet, and where
    std::set<uint32_t> absent_;  // materials of surfaces that are as if they were not there
    std::map<std::string, std::pair<Transform, Transform>> coordinate_systems_;  // start and end
    using Shapes = std::vector<std::pair<Params, State>>;  // between ObjectBegin and ObjectEnd
    std::map<std::string, Shapes> objects_;
    std::vector<std::pair<std::string, State>> instances_;  // of which object; `at`: their places
    Shapes* open_object_ = nullptr;                         // the one that is being defined
    uint64_t placed_ = 0, primitives_ = 0, vertices_ = 0;
};

}  // namespace

Scene parse_scene(const std::string& path, std::string text, std::vector<std::string>* notes,
                  const Report& report, const Limits& limits, bool stand_ins) {
    std::vector<std::string> unread;
    Input input(path, limits, report, notes ? *notes : unread, stand_ins);
    return Reader(input).read_scene(std::move(text));
}

Scene load_scene(const std::string& path, std::vector<std::string>* notes, const Report& report,
                 bool stand_ins) {
    return parse_scene(path, read_scene_file(path), notes, report, {}, stand_ins);
}
