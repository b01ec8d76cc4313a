#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/render/film_keeping.h"

void FilmClock::save(const Rendering& rendering) {
    try {
        save_film(scene_, options_, rendering);
    } catch (const InputError& error) {
        tell(error.what() + std::string("\n"));
    }
    last_ = Clock::now();
}
