#include "common/rendering/film_clock.h"

#include <cstdio>

#include "common/base/error.h"
#include "common/rendering/film_keeping.h"

void FilmClock::save(const Rendering& rendering) {
    try {
        save_film(scene_, options_, rendering);
    } catch (const InputError& error) {
        std::fprintf(stderr, "%s\n", error.what());
    }
    last_ = Clock::now();
}
