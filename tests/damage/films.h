// Damages films at random and makes their checksums right again, and asks that each is refused, or
// is a film that can be looked at, added and written as it was read.
#pragma once
#include <bit>
#include <fstream>
#include <limits>

#include "common/base/checksum.h"
#include "common/picture/film_file.h"
#include "common/results/results.h"
#include "common/results/warnings.h"
#include "tests/damage/scenes.h"

/// A film of 11 x 13 pixels with a few samples of each, some of them not finite. `kind` as in
/// FilmShape.
inline LabeledFilm any_film(int kind, bool takes_splats, uint32_t first, uint32_t last) {
    LabeledFilm f{{}, Film(11, 13, takes_splats)};
    f.label.options = {{"chapter", "07"}, {"scene", "abc"}, {"size", "11x13"}, {"paths", ""}};
    f.label.samples = {{0, first, last}};
    f.label.goals = {{0, 9, 3}};
    f.label.keep_open_goals();
    for (size_t i = 7; (kind == 1 || kind == 4) && i < 143; i += 3) f.film.mark_edge(i);
    if (kind == 1 || kind == 4) f.film.start_audit();
    if (kind == 2) f.film.start_halves();
    if (kind >= 3) f.film.start_batches();
    Sampler sampler(SamplerType::independent, 0, 1);
    for (uint32_t s = first; s < last; s++) {
        PixelSum of_pass;
        for (uint32_t i = 0; i < 143; i++) {
            sampler.start(i, s);
            auto any = [&] { return std::pow(10.0f, 20 * sampler.u1() - 10) - 1e-5f; };
            Rgb L = {any(), any(), i + s == 5 ? infinity : any()};
            if (!is_finite(L)) f.label.counts.add_not_finite(0, static_cast<int>(s), 0, 5);
            f.film.add(i, L, kind == 2 ? s % 2 : 0);
            if (f.film.has_audits() && f.film.is_audited(i)) f.film.audit(i, {any(), 1, 1});
            if (takes_splats) f.film.splat(7 * (i + s) % 143, {any(), 1, 1});
            if (takes_splats) f.film.add_total(i, {any(), 1, 1});
            of_pass.add(L);
            f.label.counts.rays += 3;
        }
        if (kind >= 3) f.film.add_to_batch(s, of_pass);
    }
    return f;
}

/// Damages films in a folder of its own.
class FilmFuzzer {
public:
    FilmFuzzer() {
        for (auto [kind, takes_splats] : {std::pair(0, false),
                                          {1, false},
                                          {2, false},
                                          {3, false},
                                          {4, true},
                                          {0, true},
                                          {1, true}})
            for (uint32_t first : {0u, 3u, 4u}) {
                films_.push_back(any_film(kind, takes_splats, first, first + 2));
                bytes_.push_back(written(films_.back()));
            }
    }

    /// The films that are damaged, as files.
    const std::vector<std::string>& films() const { return bytes_; }

    /// Reads the bytes of a film, and does with it all that is done with films. Throws InputError
    /// of one line when it is refused, and logic_error when something else is wrong.
    void use(const std::string& bytes) {
        std::ofstream(folder_ / "a.film", std::ios::binary) << bytes;
        LabeledFilm film = read_film(folder_ / "a.film");
        if (written(film) != bytes) throw std::logic_error("written otherwise than read");
        look_at(film);
        for (const LabeledFilm& other : films_) {
            LabeledFilm sum = other;
            try {
                add_film(sum, folder_ / "a.film", film);
            } catch (const InputError& error) {
                check_message(error.what());
                continue;
            }
            look_at(sum);
            std::string whole = written(sum);
            read_film(folder_ / "b.film");
        }
    }

    /// A film with a few changes, of which the last makes its checksum right.
    std::string damaged(Dice& dice) const {
        std::string bytes = bytes_[dice.below(bytes_.size())];
        bytes.resize(bytes.size() - 8);
        for (size_t changes = 1 + dice.below(3) * dice.below(2); changes > 0; changes--) {
            size_t label = bytes.find("\n\n") + 2;
            if (label > bytes.size() || dice.below(2) == 0) {
                bytes = damage_label(bytes, dice);
            } else {
                damage_sums(bytes, label, dice);
            }
        }
        return bytes + checksum(bytes);
    }

    static std::string checksum(const std::string& bytes) {
        Checksum checksum;
        checksum.add(bytes);
        auto number = std::bit_cast<std::array<char, 8>>(checksum.value());
        return {number.begin(), number.end()};
    }

private:
    std::string written(const LabeledFilm& film) const {
        write_film(folder_ / "b.film", film.label, film.film);
        return read_file(folder_ / "b.film");
    }

    /// All that is worked out from a film.
    static void look_at(const LabeledFilm& film) {
        film.film.image();
        film.film.counts();
        mean_and_error(film.film);
        warnings_of(film.film, film.label.counts);
        film.label.missing();
    }

    /// Changes a word or a line of the label.
    std::string damage_label(const std::string& bytes, Dice& dice) const {
        static const std::vector<std::string> words = split(
            "0|1|2|3|4|5|9|11|13|-1|00|65536|268435456|268435457|2147483648|"
            "4294967295|18446744073709551615|9218868437227405312||x|samples|"
            "goal|option|size|samples 2 3 0|goal 9 3 0",
            '|');
        size_t end = std::min(bytes.size(), bytes.find("\n\n") + 1);
        const std::string& other = bytes_[dice.below(bytes_.size())];
        return mutate(bytes.substr(0, end), other.substr(0, other.find("\n\n") + 1), words, dice) +
               bytes.substr(end);
    }

    /// Changes a number of the sums, or swaps two of them; now and then their count.
    static void damage_sums(std::string& bytes, size_t begin, Dice& dice) {
        constexpr size_t size = sizeof(PixelSum);
        size_t pixels = (bytes.size() - begin) / size;
        if (pixels == 0) return;
        size_t at = begin + size * dice.below(pixels), from = begin + size * dice.below(pixels);
        auto put = [&](size_t where, auto value) {
            std::memcpy(bytes.data() + at + where, &value, sizeof value);
        };
        const double numbers[] = {0, 1, -1, 1e308, -1e308, 5e-324, HUGE_VAL, std::nan("")};
        constexpr uint32_t counts[] = {0, 1, 2, 3, 1u << 28, (1u << 28) + 1, 1u << 31, 0xffffffff};
        switch (dice.below(6)) {
            case 0: return put(8 * dice.below(12), numbers[dice.below(8)]);
            case 1: return put(96 + dice.below(4), static_cast<char>(dice.below(30)));
            case 2: return put(100, counts[dice.below(8)]);
            case 3: bytes.replace(at, size, bytes.substr(from, size)); return;
            case 4: bytes.insert(at, bytes.substr(from, size)); return;
            default: bytes.erase(at, dice.below(2) == 0 ? size : 1 + dice.below(200));
        }
    }

    TemporaryFolder folder_;
    std::vector<LabeledFilm> films_;
    std::vector<std::string> bytes_;
};

/// Uses `count` damaged films, from number `first` on, as fuzz() does with scenes.
inline FuzzResult fuzz_films(uint32_t first, uint32_t count,
                             const std::function<void(uint32_t)>& begin = {}) {
    FilmFuzzer fuzzer;
    FuzzResult result;
    for (const std::string& film : fuzzer.films()) fuzzer.use(film);
    for (uint32_t i = first; i < first + count; i++) {
        if (begin) begin(i);
        Dice dice(i);
        std::string bytes = fuzzer.damaged(dice);
        double start = processor_seconds();
        try {
            fuzzer.use(bytes);
            result.read++;
        } catch (const InputError& error) {
            check_message(error.what());
            result.refused++;
        } catch (const std::exception& error) {
            throw std::logic_error("film " + std::to_string(i) + ": " + error.what());
        }
        result.slowest = std::max(result.slowest, processor_seconds() - start);
    }
    return result;
}
