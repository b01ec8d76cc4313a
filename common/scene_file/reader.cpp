#include "common/scene_file/reader.h"

#include <algorithm>
#include <span>
#include <utility>

#include "common/base/text.h"
#include "common/scene/mover.h"
#include "common/scene_file/shapes.h"

namespace {

constexpr const char *moving_light = "a light or camera that moves",
                     *unusable = "the transform has no inverse, projects, or is too large or small";

/// Reads directive by directive, in one file and in all that it includes, and keeps what holds for
/// what comes next. What is wrong with one directive does not keep it from reading the next.
class Reader {
public:
    explicit Reader(Input& input) : input_(input) {
        scene_.materials.emplace_back();  // number 0, grey, of shapes that are given none
    }

    Scene read_scene(std::string text) {
        try {
            input_.add_file(input_.main_file, text);
            read(input_.main_file, std::move(text));
            // What is missing may be in what could not be used.
            if (input_.errors.empty()) finish();
        } catch (const std::runtime_error& error) {  // an InputError, or where reading ends
            input_.add(error);
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
            {"Accelerator ColorSpace CoordSysTransform CoordinateSystem MakeNamedMedium "
             "MediumInterface Option TransformTimes",
             Block::both, &R::unsupported},
            {"Attribute", Block::both, &R::attribute},
            {"AttributeBegin TransformBegin", Block::world, &R::begin},
            {"AttributeEnd ObjectEnd TransformEnd", Block::world, &R::end},
            {"Camera", Block::options, &R::camera},
            {"Identity Translate Scale Rotate LookAt Transform ConcatTransform", Block::both,
             &R::move},
            {"Import Include", Block::both, &R::include},
            {"LightSource", Block::world, &R::light_source},
            {"MakeNamedMaterial", Block::world, &R::make_named_material},
            {"Material", Block::world, &R::material},
            {"NamedMaterial", Block::world, &R::named_material},
            {"ObjectBegin", Block::world, &R::object_begin},
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
        Lexer lexer(path, std::move(text));
        Lexer* outer = std::exchange(lexer_, &lexer);
        check_limit(at_, ++open_files_, 100, "files in each other");
        while (lexer.peek().type != Token::end) {
            try {
                read_directive(lexer.next());
            } catch (const InputError& error) {
                input_.add(error);
                lexer.skip_arguments();
            }
            if (input_.errors.size() < 20) continue;
            stop_reading({input_.main_file}, "so much is wrong that the rest is not read");
        }
        open_files_--;
        lexer_ = outer;
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
        if (block == Block::options) options_read_.insert(name_);
        (this->*read)();
    }

    Params params() { return Params(*lexer_, name_, at_, input_, state_.defaults[name_]); }
    // The name in quotes behind the directive.
    std::string name() {
        return lexer_->unescape(lexer_->expect(Token::string, name_ + " needs a name in quotes"));
    }

    void include() {
        std::string path = input_.find(at_, name()), text;
        bool is_import = name_ == "Import";
        State outer = state_;
        bool is_read = input_.try_to_read(at_, "a scene file that cannot be read",
                                          [&] { text = input_.read(path, at_); });
        if (is_read) read(path, std::move(text));
        if (is_import) state_ = outer;
    }

    void move() {
        Transform step = read_transform(*lexer_, name_);
        bool replaces = name_ == "Identity" || name_ == "Transform";
        for (auto [is_set, t] :
             {std::pair(state_.set_start, &state_.start), std::pair(state_.set_end, &state_.end)}) {
            if (!is_set) continue;
            Transform next = replaces ? step : *t * step;
            if (!is_usable(next)) fail(at_, unusable);
            *t = next;
        }
    }

    void active_transform() {
        Token which = lexer_->next();
        if (!has_word("All StartTime EndTime", std::string(which.text))) {
            lexer_->fail_at(which, "ActiveTransform needs All, StartTime or EndTime");
        }
        state_.set_start = which.text != "EndTime";
        state_.set_end = which.text != "StartTime";
    }

    void attribute() {
        static const std::map<std::string, std::string> directives = {
            {"light", "AreaLightSource LightSource"},
            {"material", "Material"},
            {"medium", ""},
            {"shape", "Shape"},
            {"texture", "Texture"}};
        const std::string whose = look_up(directives, name(), "Attribute", at_);
        while (lexer_->peek().type == Token::string) {
            Param param = read_param(*lexer_);
            param.is_default = true;
            for (const std::string& each : words_of(whose)) {
                state_.defaults[each][param.name] = param;
            }
        }
    }

    void unsupported() {
        lexer_->skip_arguments();
        if (or_stand_in(name_).empty()) return input_.note(at_, name_ + " is ignored");
        input_.stand_in(at_, name_);
    }

    void camera() {
        Params read = params();
        scene_.camera = read_camera(read, inverse(still_transform(read)));
    }

    void setting() { read_setting(name_, params(), scene_); }

    void world_begin() {
        in_world_ = true;
        state_.start = state_.end = {};
        state_.set_start = state_.set_end = true;
    }

    void area_light_source() { state_.emission = read_area_light(params()); }

    void begin() { blocks_.push_back({name_, at_, state_}); }

    void end() {
        if (blocks_.empty() || blocks_.back().name.front() != name_.front()) {
            fail(at_, name_ + " without a beginning");
        }
        if (name_ == "ObjectEnd") open_object_ = nullptr;
        state_ = blocks_.back().state;
        blocks_.pop_back();
    }

    void light_source() {
        Params read = params();
        bool is_sky = read.type() == "infinite", is_picture = read.find("filename");
        // A sky of one color is the same wherever it stands.
        Transform place = is_sky && !is_picture ? Transform{} : still_transform(read);
        if (is_picture && sky_image_) fail(at_, "a second picture of the sky");
        if (is_picture) sky_image_ = read_sky_image(read, place);
        if (sky_image_ && is_picture) return;
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
        std::optional<Material> material = read_material(params(), textures_);
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

    // They are placed when all objects are known.
    void object_instance() {
        std::string own = name();
        if (open_object_) fail(at_, "ObjectInstance inside an object");
        instances_.push_back({own, at_, state_});
    }

    void place_instances() {
        for (const auto& [object, at, state] : instances_) {
            for (const auto& [shape, inside] : look_up(objects_, object, "object", at)) {
                State where = inside;
                where.start = state.start * inside.start;
                where.end = state.end * inside.end;
                if (!is_usable(where.start) || !is_usable(where.end)) fail(at, unusable);
                place(shape, where);
            }
        }
    }

    void shape() {
        Params read = params();
        if (!open_object_) return place(read, state_);
        // Keep it for the instances.
        open_object_->push_back({read, state_});
        State& kept = open_object_->back().second;
        if (kept.emission) input_.note(at_, "lights inside an object are left out, as in pbrt");
        kept.emission = {};
    }

    void place(const Params& params, State where) {
        const Param* alpha = params.find("alpha");
        bool is_clear = alpha && alpha->numbers == std::vector<double>{0} && !where.emission;
        bool is_nothing = params.stands_in() && params.type() != "loopsubdiv";
        if (absent_.contains(where.material) || is_nothing || is_clear) return;
        bool moves = where.start != where.end;
        if (moves && where.emission) input_.stand_in(params.at(), moving_light);
        std::shared_ptr<Mover> mover;
        if (moves && !where.emission) {
            mover = std::make_shared<Mover>(where.start, where.end);
            mover->at = kept(params.at());
            std::swap(scene_.geometry, mover->geometry);
        }
        read_shape(params, where, scene_);
        const Geometry& g = scene_.geometry;
        check_limit(params.at(), g.size(), input_.limits.primitives, "primitives");
        check_limit(params.at(), g.positions.size(), input_.limits.vertices, "vertices");
        if (!mover) return;
        std::swap(scene_.geometry, mover->geometry);
        if (mover->geometry.size() > 0) scene_.movers.push_back(mover);
    }

    void texture() { textures_.read(*lexer_, at_, input_, state_.defaults["Texture"]); }

    // The current transform; not supported where it moves while the shutter is open.
    Transform still_transform(const Params& params) {
        if (state_.start != state_.end) input_.stand_in(params.at(), moving_light);
        return state_.start;
    }

    // A mesh may be given a material that is made later.
    void check_uvs(const Geometry& g) {
        for (const Triangle& t : g.triangles) {
            Shape& shape = scene_.shapes[t.shape];
            bool has_uv = !g.uvs.empty() && !std::isnan(g.uvs[t.v[0]].x);
            if (scene_.materials[shape.material].texture == 0 || has_uv) continue;
            input_.stand_in(*shape.at, "a textured mesh without usable uv");
            shape.material = 0;
        }
    }

    // pbrt renders what is missing without complaint, and we only with stand-ins.
    void check_complete() {
        Position file = {input_.main_file};
        if (!blocks_.empty()) fail(blocks_.back().at, blocks_.back().name + " is never closed");
        for (const auto& [name, at] : unmade_) named_materials_.erase(name);
        for (const auto& [name, at] : unmade_) {
            input_.error(at, unknown("material", name, names_of(named_materials_)));
        }
        place_instances();
        check_uvs(scene_.geometry);
        for (const auto& mover : scene_.movers) check_uvs(mover->geometry);
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
            sky.at = kept(file);
            scene_.lights.push_back(sky);
        }
        if (!options_read_.contains("PixelFilter")) {
            input_.note(file, "no PixelFilter: pbrt's \"gaussian\" is replaced by the box");
        }
    }

    // Gives each area light its range of primitives.
    void number_light_primitives() {
        for (uint32_t prim = 0; prim < scene_.geometry.size(); prim++) {
            int index = shape_of(scene_, prim).light;
            if (index < 0) continue;
            Light& light = scene_.lights[static_cast<size_t>(index)];
            if (light.prims++ == 0) light.first_prim = prim;
        }
    }

    // Gives a light what pbrt's film does: twice the exposure is a picture twice as bright.
    void expose(std::span<Rgb> L, const Position* at) {
        // From all sides, and 1e9 m away: 1e35 W. Powers of brighter lights may be no floats.
        constexpr float brightest = 1e15f;
        const Camera& camera = scene_.camera;
        float exposure = camera.shutter_close - camera.shutter_open, most = 0;
        for (Rgb& each : L) {
            each *= exposure;
            most = std::max(most, is_finite(each) ? max_component(each) : infinity);
        }
        if (most > 0 && most <= brightest) return;
        input_.error(*at, "the light, times the shutter's time, is 0 or more than 1e15");
    }

    void finish() {
        check_complete();
        number_light_primitives();
        for (Light& light : scene_.lights) expose({&light.L, 1}, light.at);
        if (sky_image_) {
            expose(sky_image_->pixels, sky_image_->at_file);
            scene_.sky_image = std::make_shared<SkyImage>(std::move(*sky_image_));
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
    bool in_world_ = false;

    Lexer* lexer_ = nullptr;              // of the innermost file
    std::string name_;                    // of the directive that is read
    Position at_;                         // where it stands
    std::set<std::string> options_read_;  // Camera and its like
    uint64_t directives_read_ = 0, open_files_ = 0;

    /// The state where a block or an instance of an object begins, with the name of which.
    struct Place {
        std::string name;
        Position at;
        State state;
    };
    State state_;
    std::vector<Place> blocks_;
    std::map<std::string, uint32_t> named_materials_;  // into Scene::materials
    std::map<std::string, Position> unmade_;           // those that are only used yet, and where
    std::set<uint32_t> absent_;  // materials of surfaces that are as if they were not there
    using Shapes = std::vector<std::pair<Params, State>>;  // between ObjectBegin and ObjectEnd
    std::map<std::string, Shapes> objects_;
    std::vector<Place> instances_;
    Shapes* open_object_ = nullptr;  // the one that is being defined
};

}  // namespace

Scene parse_scene(const std::string& path, std::string text, std::vector<std::string>* notes,
                  const Report& report, const Limits& limits, bool stand_ins) {
    std::vector<std::string> unread;
    Input input = {path, limits, report, stand_ins, notes ? *notes : unread};
    return Reader(input).read_scene(std::move(text));
}

Scene load_scene(const std::string& path, std::vector<std::string>* notes, const Report& report,
                 bool stand_ins) {
    return parse_scene(path, read_scene_file(path), notes, report, {}, stand_ins);
}
