#include "common/radiosity/solution.h"

Balance balance_of(const std::vector<Patch>& patch, const Solution& s) {
    Balance b;
    for (size_t i = 0; i < patch.size(); i++) {
        double A = double{patch[i].area};
        b.emitted += A * sum_of(patch[i].E);
        b.absorbed += A * sum_of(s.H[i] - patch[i].rho * s.H[i]);
        if (!s.unshot.empty()) b.unshot += A * sum_of(s.unshot[i]);
    }
    b.escaped = sum_of(s.escaped);
    return b;
}
