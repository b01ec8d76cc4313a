#include "tests/diagnose/explanations.h"

#include <algorithm>
#include <cmath>

namespace {

bool is_dark(const std::string& key) { return key.ends_with(" dark"); }

/// The error of a prediction beside the noise of both measurements.
double model_error(const std::string& key, double predicted) {
    return is_dark(key) ? 1e-3 : 0.01 * std::max(std::abs(predicted), 0.3);
}

Fit fit_of(const Hypothesis& h, const Evidence& evidence) {
    Fit fit{&h, 0, 0};
    Evidence numbers = evidence;
    for (const auto& [key, q] : h.predicted)  // of light that was not found there is none
        if (is_dark(key)) numbers.insert({key, Quantity{}});
    for (const auto& [key, q] : numbers) {
        auto found = h.predicted.find(key);
        // What is not written down was less than 3 standard errors away, of fewer samples: where
        // those are large, it may be as far away.
        Quantity p = {is_dark(key) ? 0.0 : 1.0, q.se > 0.01 ? 2 * q.se : 0};
        if (found != h.predicted.end()) p = found->second;
        double error = std::hypot(q.se, p.se, model_error(key, p.mean));
        double z = std::abs(q.mean - p.mean) / error;
        fit.worst = std::max(fit.worst, z);
        fit.log_likelihood -= std::min(z * z, 60.0) / 2 + std::log(error);
    }
    return fit;
}

}  // namespace

std::vector<Fit> explanations(const std::vector<Hypothesis>& hypotheses, const Evidence& evidence) {
    // What a mistake must explain better than a right program does: else it explains nothing.
    const Hypothesis no_mistake{"-", "", {}};
    double least = fit_of(no_mistake, evidence).log_likelihood + std::log(1000.0);
    std::vector<Fit> fits;
    for (const Hypothesis& h : hypotheses) {
        Fit fit = fit_of(h, evidence);
        if (fit.worst < 6 && fit.log_likelihood > least) fits.push_back(fit);
    }
    std::sort(fits.begin(), fits.end(),
              [](const Fit& a, const Fit& b) { return a.log_likelihood > b.log_likelihood; });
    return fits;
}
