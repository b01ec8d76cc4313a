// Chapter 20, the solvers: from form factors to the radiosity of each patch.
//
//   B_i = E_i + rho_i H_i,    H_i = sum over j of F_ij B_j       (irradiance, W m^-2)
//
// F_ij, not F_ji: what i receives is counted from i. With G_ij = A_i F_ij:  H_i = sum G_ij B_j /
// A_i.
#pragma once
#include <functional>
#include <optional>

#include "chapters/20_radiosity/form_factors.h"

namespace ch20 {

/// W m^-2 in red, green and blue. In double: a thousand sweeps must not lose energy.
struct Radiosity {
    double r = 0, g = 0, b = 0;
};
inline Radiosity operator+(Radiosity x, Radiosity y) { return {x.r + y.r, x.g + y.g, x.b + y.b}; }
inline Radiosity operator-(Radiosity x, Radiosity y) { return {x.r - y.r, x.g - y.g, x.b - y.b}; }
inline Radiosity operator*(double s, Radiosity x) { return {s * x.r, s * x.g, s * x.b}; }
inline Radiosity operator*(Rgb rho, Radiosity x) {
    return {double{rho.r} * x.r, double{rho.g} * x.g, double{rho.b} * x.b};
}
inline Radiosity& operator+=(Radiosity& x, Radiosity y) { return x = x + y; }
inline Radiosity to_radiosity(Rgb x) { return {double{x.r}, double{x.g}, double{x.b}}; }
inline double sum_of(Radiosity x) { return x.r + x.g + x.b; }
inline double largest_of(Radiosity x) {
    return std::max({std::abs(x.r), std::abs(x.g), std::abs(x.b)});
}

/// What each patch receives so far.
struct Solution {
    std::vector<Radiosity> H;       // W m^-2
    std::vector<Radiosity> unshot;  // of B: what others have not received; progressive alone
    uint64_t steps = 0;             // sweeps, or shots
    Radiosity escaped;              // W, out of the room; progressive alone
};
inline Radiosity radiosity_of(const Patch& p, Radiosity H) { return to_radiosity(p.E) + p.rho * H; }

/// All of G, m^2, row by row.
using Matrix = std::vector<std::vector<float>>;
inline Matrix make_matrix(Rows& rows, size_t n) {
    for (size_t i = 0; i < n; i++) rows.row(i);
    return rows.take_all();
}

/// Makes the rows' sums right, and keeps G_ij = G_ji: each row and column is multiplied by d_i.
///
///   sum over j of d_i G_ij d_j = A_i        in a closed room; in an open one only where it is more
///
/// tested by  "identity: repaired rows sum to 1, and both ends agree"
inline void repair(Matrix& m, const std::vector<Patch>& patch, bool closed) {
    std::vector<double> d(m.size(), 1), sum(m.size());
    for (int round = 0; round < 1000; round++) {
        double off = 0;
        for (size_t i = 0; i < m.size(); i++) {
            sum[i] = 0;
            for (size_t j = 0; j < m.size(); j++) sum[i] += double{m[i][j]} * d[j];
            sum[i] *= d[i] / double{patch[i].area};
            if (sum[i] > 0 && (closed || sum[i] > 1)) off = std::max(off, std::abs(sum[i] - 1));
        }
        if (off < 1e-7) break;
        for (size_t i = 0; i < m.size(); i++) {
            if (sum[i] > 0 && (closed || sum[i] > 1)) d[i] /= std::sqrt(sum[i]);
        }
    }
    for (size_t i = 0; i < m.size(); i++) {
        for (size_t j = 0; j < m.size(); j++) {
            m[i][j] = static_cast<float>(double{m[i][j]} * (d[i] * d[j]));
        }
    }
}

inline Radiosity gather(const Matrix& m, const std::vector<Patch>& patch,
                        const std::vector<Radiosity>& H, size_t i) {
    Radiosity sum;
    for (size_t j = 0; j < m.size(); j++) {
        if (m[i][j] > 0) sum += double{m[i][j]} * radiosity_of(patch[j], H[j]);
    }
    return 1 / double{patch[i].area} * sum;
}

/// One sweep: each patch gathers. Jacobi: what the others had before the sweep, which is one bounce
/// of light. Gauss-Seidel: what they have by now. Returns the largest change.
inline double sweep_jacobi(const Matrix& m, const std::vector<Patch>& patch, Solution& s) {
    std::vector<Radiosity> before = s.H;
    double change = 0;
    for (size_t i = 0; i < m.size(); i++) {
        s.H[i] = gather(m, patch, before, i);
        change = std::max(change, largest_of(s.H[i] - before[i]));
    }
    s.steps++;
    return change;
}
inline double sweep_gauss_seidel(const Matrix& m, const std::vector<Patch>& patch, Solution& s) {
    double change = 0;
    for (size_t i = 0; i < m.size(); i++) {
        Radiosity before = s.H[i];
        s.H[i] = gather(m, patch, s.H, i);
        change = std::max(change, largest_of(s.H[i] - before));
    }
    s.steps++;
    return change;
}

/// Sweeps until what is still to come is below `wanted`, a share of the largest H.
///
///   still to come <= q / (1 - q) change,    q = this change / the one before
///
/// The change alone would lie: where each bounce keeps 99 %, a hundred more like it follow.
template <class Sweep>
void solve(const Matrix& m, const std::vector<Patch>& patch, double wanted, Solution& s,
           const Sweep& sweep, const std::function<bool(double)>& stop) {
    s.H.resize(m.size());
    double before = 0;
    for (int i = 0; i < 100000; i++) {
        double change = sweep(m, patch, s), q = before > 0 ? change / before : 1, largest = 0;
        before = change;
        for (Radiosity H : s.H) largest = std::max(largest, largest_of(H));
        double to_come = q < 1 ? q / (1 - q) * change : infinity;
        if (change == 0 || to_come <= wanted * largest || stop(to_come / largest)) return;
    }
}

/// Progressive refinement (Southwell): the patch with most unshot power shoots it to all others.
///
///   H_j += F_ji dB_i A_i / A_j = G_ij dB_i / A_j;      dB_j += rho_j H_j's change;      dB_i = 0
///
/// Needs one row of G. That row alone is repaired: what i shoots, and does not leave the room,
/// arrives. Returns the patch, nothing when all is shot.
using Row = std::function<std::span<const float>(size_t i)>;
inline void start(const std::vector<Patch>& patch, Solution& s) {
    s.H.assign(patch.size(), {});
    s.unshot.clear();
    for (const Patch& p : patch) s.unshot.push_back(to_radiosity(p.E));
}
inline std::optional<size_t> shoot(const Patches& patches, const Row& row, Solution& s) {
    const std::vector<Patch>& patch = patches.patch;
    size_t i = 0;
    double most = 0;
    for (size_t j = 0; j < patch.size(); j++) {
        double power = double{patch[j].area} * sum_of(s.unshot[j]);
        if (power > most) most = power, i = j;
    }
    if (most == 0) return {};
    std::span<const float> G = row(i);
    double sum = 0, area = double{patch[i].area};
    for (float G_ij : G) sum += double{G_ij};
    double scale = sum > area || (patches.closed && sum > 0) ? area / sum : 1;
    Radiosity dB = s.unshot[i];
    s.unshot[i] = {};
    s.escaped += (area - scale * sum) * dB;
    for (size_t j = 0; j < patch.size(); j++) {
        if (G[j] == 0) continue;
        Radiosity dH = scale * double{G[j]} / double{patch[j].area} * dB;
        s.H[j] += dH;
        s.unshot[j] += patch[j].rho * dH;
    }
    s.steps++;
    return i;
}

/// What is unshot will light the room about evenly: its irradiance, for display, as long as it
/// lasts.
///
///   H = keep dB / (1 - keep rho),    dB, rho: means over all areas; keep: what stays in the room
///
/// source  Cohen, Chen, Wallace, Greenberg 1988
inline Radiosity ambient(const std::vector<Patch>& patch, const Solution& s) {
    Radiosity unshot, rho, shot;
    double area = 0;
    for (size_t i = 0; i < s.unshot.size(); i++) {
        double A = double{patch[i].area};
        area += A;
        unshot += A * s.unshot[i];
        rho += A * to_radiosity(patch[i].rho);
        shot += A * (radiosity_of(patch[i], s.H[i]) - s.unshot[i]);
    }
    auto estimate = [&](double dB, double r, double out, double all) {
        double keep = all > 0 ? 1 - out / all : 1;
        return area > 0 ? keep * dB / (area - std::min(keep * r, 0.99 * area)) : 0;
    };
    return {estimate(unshot.r, rho.r, s.escaped.r, shot.r),
            estimate(unshot.g, rho.g, s.escaped.g, shot.g),
            estimate(unshot.b, rho.b, s.escaped.b, shot.b)};
}

/// Which share of all light in the room is still to come, by that estimate.
inline double share_to_come(const std::vector<Patch>& patch, const Solution& s) {
    double received = 0, area = 0;
    for (size_t i = 0; i < patch.size(); i++) {
        received += double{patch[i].area} * sum_of(s.H[i]), area += double{patch[i].area};
    }
    double to_come = area * sum_of(ambient(patch, s));
    return to_come > 0 ? to_come / (received + to_come) : 0;
}

/// Where the power of the lamps went, W: emitted = absorbed + escaped + unshot.
struct Balance {
    double emitted = 0, absorbed = 0, escaped = 0, unshot = 0;
    double error() const { return (absorbed + escaped + unshot) / emitted - 1; }
};
inline Balance balance_of(const std::vector<Patch>& patch, const Solution& s) {
    Balance b;
    for (size_t i = 0; i < patch.size(); i++) {
        double A = double{patch[i].area};
        b.emitted += A * sum_of(to_radiosity(patch[i].E));
        b.absorbed += A * sum_of(s.H[i] - patch[i].rho * s.H[i]);
        if (!s.unshot.empty()) b.unshot += A * sum_of(s.unshot[i]);
    }
    b.escaped = sum_of(s.escaped);
    return b;
}
/// What leaves the room, by the rows of a matrix.
inline Radiosity escaped_by(const Matrix& m, const std::vector<Patch>& patch, const Solution& s) {
    Radiosity escaped;
    for (size_t i = 0; i < m.size(); i++) {
        double sum = 0;
        for (float G : m[i]) sum += double{G};
        escaped += (double{patch[i].area} - sum) * radiosity_of(patch[i], s.H[i]);
    }
    return escaped;
}

}  // namespace ch20
