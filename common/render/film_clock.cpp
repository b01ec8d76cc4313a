#include "common/render/film_clock.h"

#include "common/render/film_keeping.h"

void FilmClock::save(const Rendering& rendering) {
    try_to_save_film(scene_, options_, rendering);
    last_ = Clock::now();
}
