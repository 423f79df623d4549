// The tracer is compiled for the machine at hand with all that its compiler knows: loops over a block's rays become
// vector instructions.
#include "chain.hpp"

#if __has_include(<embree4/rtcore.h>) // Debian 13, Ubuntu 24.04
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <thread>

namespace peer {

namespace {

constexpr int capacity = 256; // rays of a block at most: its arrays stay in the first-level cache
using Lane = std::array<double, capacity>;

// Rays of a block: positions in mm, unit directions.
struct Rays {
    alignas(64) Lane x, y, z, dx, dy, dz;
    int count = 0;

    void copy(int from, int to) {
        for (Lane* lane : {&x, &y, &z, &dx, &dy, &dz}) {
            (*lane)[static_cast<std::size_t>(to)] = (*lane)[static_cast<std::size_t>(from)];
        }
    }
    // Keeps the rays with alive[i] > 0.
    void compact(const Lane& alive) {
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            if (alive[static_cast<std::size_t>(i)] > 0) {
                copy(i, kept++);
            }
        }
        count = kept;
    }
};

// xoshiro256+ (D. Blackman, S. Vigna, "Scrambled linear pseudorandom number generators", 2018), eight streams
// side by side.
class Generator {
  public:
    explicit Generator(std::uint64_t seed) {
        for (auto& word : state_) {
            for (auto& stream : word) { // splitmix64, as its authors advise
                std::uint64_t z = (seed += 0x9E3779B97F4A7C15u);
                z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
                z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
                stream = z ^ (z >> 31);
            }
        }
    }
    // Fills u with numbers uniform in [0, 1), of 52 bits. Writes multiples of eight.
    void fill(Lane& u, int count) {
        for (int first = 0; first < count; first += 8) {
            for (int k = 0; k < 8; ++k) {
                const std::uint64_t sum = state_[0][k] + state_[3][k];
                u[static_cast<std::size_t>(first + k)] = std::bit_cast<double>((sum >> 12) | 0x3FF0000000000000u) - 1.0;
                const std::uint64_t shifted = state_[1][k] << 17;
                state_[2][k] ^= state_[0][k];
                state_[3][k] ^= state_[1][k];
                state_[1][k] ^= state_[2][k];
                state_[0][k] ^= state_[3][k];
                state_[2][k] ^= shifted;
                state_[3][k] = std::rotl(state_[3][k], 45);
            }
        }
    }

  private:
    alignas(64) std::uint64_t state_[4][8];
};

// Takes rays to the surface's frame, to the surface, through its edge and by Snell's law in vector form: d' = mu d +
// (sqrt(1 - mu^2 (1 - cos^2)) - mu cos) n.
template <Surface::Shape shape, bool refracts>
void pass(const Surface& surface, Rays& rays, Lane& alive) {
    const double c = surface.curvature;
    const double k1 = 1 + surface.conic;
    const double mu = surface.index_ratio;
    const double edge = surface.semi_diameter_squared;
    const double distance = surface.distance;
    std::array<double, 8> even{};
    std::copy(surface.even.begin(), surface.even.end(), even.begin());
    double* __restrict px = rays.x.data();
    double* __restrict py = rays.y.data();
    double* __restrict pz = rays.z.data();
    double* __restrict pdx = rays.dx.data();
    double* __restrict pdy = rays.dy.data();
    double* __restrict pdz = rays.dz.data();
    double* __restrict ok = alive.data();
    for (int i = 0; i < rays.count; ++i) {
        const double dx = pdx[i], dy = pdy[i], dz = pdz[i];
        const double to_vertex = (distance - pz[i]) / dz;
        double x = px[i] + to_vertex * dx;
        double y = py[i] + to_vertex * dy;
        double z = 0;
        double nx = 0, ny = 0, nz = 1;
        bool passes = true;
        if constexpr (shape != Surface::Shape::plane) {
            // The quadric c (x^2 + y^2 + (1 + k) z^2) = 2 z is met from the vertex plane: the root is the one that
            // vanishes with c.
            const double constant = c * (x * x + y * y);
            const double half = dz - c * (x * dx + y * dy);
            const double square = shape == Surface::Shape::sphere ? c : c * (1 + (k1 - 1) * dz * dz);
            const double discriminant = half * half - square * constant;
            passes = discriminant >= 0;
            const double t = constant / (half + std::sqrt(std::max(discriminant, 0.0)));
            x += t * dx;
            y += t * dy;
            z = t * dz;
            nx = -c * x;
            ny = -c * y;
            nz = 1 - c * z;
            if constexpr (shape != Surface::Shape::sphere) {
                nz = 1 - c * k1 * z;
            }
            if constexpr (shape == Surface::Shape::asphere) {
                for (int step = 0; step < 6; ++step) { // Newton's, on z - sag
                    const double r2 = x * x + y * y;
                    const double root = std::sqrt(std::max(1 - k1 * c * c * r2, 1e-12));
                    double polynomial = 0, derivative = 0; // both over r^2, with u = r^2
                    for (int n = 7; n >= 0; --n) {
                        polynomial = polynomial * r2 + even[static_cast<std::size_t>(n)];
                        derivative = derivative * r2 + (2 * n + 4) * even[static_cast<std::size_t>(n)];
                    }
                    const double sag = c * r2 / (1 + root) + polynomial * r2 * r2;
                    const double slope = c / root + derivative * r2; // over r
                    nx = -slope * x;
                    ny = -slope * y;
                    nz = 1;
                    const double back = (z - sag) / (dx * nx + dy * ny + dz);
                    x -= back * dx;
                    y -= back * dy;
                    z -= back * dz;
                }
            }
            if constexpr (shape != Surface::Shape::sphere) {
                const double scale = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
                nx *= scale;
                ny *= scale;
                nz *= scale;
            }
        }
        passes = passes && x * x + y * y <= edge;
        px[i] = x;
        py[i] = y;
        pz[i] = z;
        if constexpr (refracts) {
            const double cosine = dx * nx + dy * ny + dz * nz;
            const double under_root = 1 - mu * mu * (1 - cosine * cosine);
            passes = passes && under_root >= 0;
            const double turn = std::sqrt(std::max(under_root, 0.0)) - mu * cosine;
            const double new_dz = mu * dz + turn * nz;
            passes = passes && new_dz > 0;
            pdx[i] = mu * dx + turn * nx;
            pdy[i] = mu * dy + turn * ny;
            pdz[i] = new_dz;
        }
        ok[i] = passes ? ok[i] : 0.0;
    }
}

template <Surface::Shape shape>
void pass(const Surface& surface, Rays& rays, Lane& alive) {
    surface.index_ratio == 1 ? pass<shape, false>(surface, rays, alive) : pass<shape, true>(surface, rays, alive);
}

// Leaves only the rays that came through. Rays close up when a quarter of them has gone.
void pass_train(const std::vector<Surface>& train, Rays& rays) {
    alignas(64) Lane alive;
    alive.fill(1);
    for (const Surface& surface : train) {
        switch (surface.shape) {
        case Surface::Shape::plane:
            pass<Surface::Shape::plane>(surface, rays, alive);
            break;
        case Surface::Shape::sphere:
            pass<Surface::Shape::sphere>(surface, rays, alive);
            break;
        case Surface::Shape::conic:
            pass<Surface::Shape::conic>(surface, rays, alive);
            break;
        case Surface::Shape::asphere:
            pass<Surface::Shape::asphere>(surface, rays, alive);
            break;
        }
        double left = 0;
        for (int i = 0; i < rays.count; ++i) {
            left += alive[static_cast<std::size_t>(i)];
        }
        if (left < 0.75 * rays.count) {
            rays.compact(alive);
            std::fill_n(alive.begin(), rays.count, 1.0);
        }
    }
    rays.compact(alive);
}

void fly_to(double plane, Rays& rays) {
    for (int i = 0; i < rays.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double t = (plane - rays.z[k]) / rays.dz[k];
        rays.x[k] += t * rays.dx[k];
        rays.y[k] += t * rays.dy[k];
        rays.z[k] = 0;
    }
}

// The cosine and the sine of 2 pi u, in two loops: the compiler makes vector instructions of either, but not of both in
// one loop.
void turn(const Lane& u, int count, Lane& cosine, Lane& sine) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
        cosine[k] = std::cos(2 * std::numbers::pi * u[k]);
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
        sine[k] = std::sin(2 * std::numbers::pi * u[k]);
    }
}

// Emits from a Lambertian disc: uniform in area, and in the direction's tangential part within a disc or a rectangle
// about its middle.
void emit(const Chain& chain, Generator& generator, int count, Rays& rays) {
    alignas(64) Lane u0, u1, u2, u3;
    for (Lane* u : {&u0, &u1, &u2, &u3}) {
        generator.fill(*u, count);
    }
    turn(u1, count, rays.x, rays.y);
    if (chain.emission_half_width > 0) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
            rays.dx[k] = chain.emission_half_width * (2 * u2[k] - 1);
            rays.dy[k] = chain.emission_half_height * (2 * u3[k] - 1);
        }
    } else {
        turn(u3, count, rays.dx, rays.dy);
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
            const double sine = chain.emission_sine * std::sqrt(u2[k]);
            rays.dx[k] *= sine;
            rays.dy[k] *= sine;
        }
    }
    for (int i = 0; i < count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double radius = chain.source_radius * std::sqrt(u0[k]);
        rays.x[k] *= radius;
        rays.y[k] *= radius;
        rays.z[k] = -chain.source_distance;
        rays.dx[k] += chain.emission_shift * rays.x[k];
        rays.dy[k] += chain.emission_shift * rays.y[k];
        rays.dz[k] = std::sqrt(std::max(0.0, 1 - rays.dx[k] * rays.dx[k] - rays.dy[k] * rays.dy[k]));
    }
    rays.count = count;
}

// Normals where rays met the specimen.
struct Normals {
    alignas(64) Lane x, y, z;
};

// Draws directions about each ray's mirror direction with the density p(alpha; g) cos(theta), p Henyey's and
// Greenstein's, by rejection: from p with cos(theta), or from the cosine law with p over its greatest value, whichever
// accepts more.
void scatter(double g, Generator& generator, Rays& rays, const Normals& normals) {
    const bool from_cosine = 4 * (1 - g) * (1 - g) > 1 + g;
    struct Pending {
        alignas(64) Lane mx, my, mz, nx, ny, nz, dx, dy, dz, accepted;
        std::array<int, capacity> ray;
    } pending;
    int count = rays.count;
    for (int i = 0; i < count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double twice = 2 * (rays.dx[k] * normals.x[k] + rays.dy[k] * normals.y[k] + rays.dz[k] * normals.z[k]);
        pending.mx[k] = rays.dx[k] - twice * normals.x[k];
        pending.my[k] = rays.dy[k] - twice * normals.y[k];
        pending.mz[k] = rays.dz[k] - twice * normals.z[k];
        pending.nx[k] = normals.x[k];
        pending.ny[k] = normals.y[k];
        pending.nz[k] = normals.z[k];
        pending.ray[k] = i;
    }
    alignas(64) Lane u0, u1, u2, u3, cosines, sines;
    while (count > 0) {
        for (Lane* u : {&u0, &u1, &u2}) {
            generator.fill(*u, count);
        }
        if (!from_cosine) {
            generator.fill(u3, count);
        }
        turn(u1, count, cosines, sines);
        for (int i = 0; i < count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            // The direction starts as a point of the unit sphere.
            const double sz = 1 - 2 * u0[k];
            const double across = std::sqrt(std::max(1 - sz * sz, 0.0));
            const double sx = across * cosines[k], sy = across * sines[k];
            const double mx = pending.mx[k], my = pending.my[k], mz = pending.mz[k];
            double dx, dy, dz, least;
            if (from_cosine) {
                // The point of the sphere and the normal, added up, follow the cosine law.
                dx = pending.nx[k] + sx;
                dy = pending.ny[k] + sy;
                dz = pending.nz[k] + sz;
                const double scale = 1 / std::sqrt(std::max(dx * dx + dy * dy + dz * dz, 1e-30));
                dx *= scale;
                dy *= scale;
                dz *= scale;
                const double base = (1 - g) * (1 - g) / (1 + g * g - 2 * g * (dx * mx + dy * my + dz * mz));
                least = base * std::sqrt(base);
            } else {
                // The point's part at right angles to the mirror direction has a uniform azimuth.
                const double ratio = (1 - g * g) / (1 - g + 2 * g * u3[k]);
                const double cosine = g != 0 ? (1 + g * g - ratio * ratio) / (2 * g) : 2 * u3[k] - 1;
                const double along = sx * mx + sy * my + sz * mz;
                const double tx = sx - along * mx, ty = sy - along * my, tz = sz - along * mz;
                const double scale =
                    std::sqrt(std::max(1 - cosine * cosine, 0.0) / std::max(tx * tx + ty * ty + tz * tz, 1e-30));
                dx = cosine * mx + scale * tx;
                dy = cosine * my + scale * ty;
                dz = cosine * mz + scale * tz;
                least = dx * pending.nx[k] + dy * pending.ny[k] + dz * pending.nz[k];
            }
            pending.dx[k] = dx;
            pending.dy[k] = dy;
            pending.dz[k] = dz;
            pending.accepted[k] = u2[k] < least ? 1.0 : 0.0;
        }
        int left = 0;
        for (int i = 0; i < count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            if (pending.accepted[k] > 0) {
                const auto ray = static_cast<std::size_t>(pending.ray[k]);
                rays.dx[ray] = pending.dx[k];
                rays.dy[ray] = pending.dy[k];
                rays.dz[ray] = pending.dz[k];
                continue;
            }
            const auto to = static_cast<std::size_t>(left++);
            for (Lane* lane : {&pending.mx, &pending.my, &pending.mz, &pending.nx, &pending.ny, &pending.nz}) {
                (*lane)[to] = (*lane)[k];
            }
            pending.ray[to] = pending.ray[k];
        }
        count = left;
    }
}

// Embree 3 wants a context with each query, Embree 4 may have arguments. The mask of valid rays comes first,
// if any.
#if RTC_VERSION_MAJOR >= 4
template <class Query>
void ask(auto function, RTCScene scene, Query& query) {
    function(scene, &query, nullptr);
}
template <class Query>
void ask(auto function, const int* valid, RTCScene scene, Query& query) {
    function(valid, scene, &query, nullptr);
}
#else
template <class Query>
void ask(auto function, RTCScene scene, Query& query) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    function(scene, &context, &query);
}
template <class Query>
void ask(auto function, const int* valid, RTCScene scene, Query& query) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    function(valid, scene, &context, &query);
}
#endif

// The packets of Embree by their size.
template <int width>
struct Packet;
template <>
struct Packet<8> {
    using RayHit = RTCRayHit8;
    using Ray = RTCRay8;
    static constexpr auto intersect = rtcIntersect8;
    static constexpr auto occluded = rtcOccluded8;
};
template <>
struct Packet<16> {
    using RayHit = RTCRayHit16;
    using Ray = RTCRay16;
    static constexpr auto intersect = rtcIntersect16;
    static constexpr auto occluded = rtcOccluded16;
};

template <class Ray>
void set_ray(Ray& ray, const Rays& rays, int i) {
    const auto k = static_cast<std::size_t>(i);
    ray.org_x = static_cast<float>(rays.x[k]);
    ray.org_y = static_cast<float>(rays.y[k]);
    ray.org_z = static_cast<float>(rays.z[k]);
    ray.dir_x = static_cast<float>(rays.dx[k]);
    ray.dir_y = static_cast<float>(rays.dy[k]);
    ray.dir_z = static_cast<float>(rays.dz[k]);
    ray.tnear = 0;
    ray.tfar = std::numeric_limits<float>::max();
    ray.mask = ~0u;
    ray.flags = 0;
}

template <class RayN>
void set_lane(RayN& ray, int lane, const Rays& rays, int i) {
    RTCRay one;
    set_ray(one, rays, i);
    ray.org_x[lane] = one.org_x;
    ray.org_y[lane] = one.org_y;
    ray.org_z[lane] = one.org_z;
    ray.dir_x[lane] = one.dir_x;
    ray.dir_y[lane] = one.dir_y;
    ray.dir_z[lane] = one.dir_z;
    ray.tnear[lane] = one.tnear;
    ray.tfar[lane] = one.tfar;
    ray.mask[lane] = one.mask;
    ray.flags[lane] = one.flags;
}

// Finds the nearest hits: found[i] > 0 if the ray met, with the distance and the normal as Embree has it.
template <int width>
void find_hits(RTCScene scene, const Rays& rays, Lane& found, Lane& distance, Normals& normals) {
    const auto keep = [&](int i, unsigned geometry, float far, float x, float y, float z) {
        const auto k = static_cast<std::size_t>(i);
        found[k] = geometry != RTC_INVALID_GEOMETRY_ID ? 1.0 : 0.0;
        distance[k] = far;
        normals.x[k] = x;
        normals.y[k] = y;
        normals.z[k] = z;
    };
    if constexpr (width == 1) {
        for (int i = 0; i < rays.count; ++i) {
            RTCRayHit query;
            set_ray(query.ray, rays, i);
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            ask(rtcIntersect1, scene, query);
            keep(i, query.hit.geomID, query.ray.tfar, query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
        }
    } else {
        for (int first = 0; first < rays.count; first += width) {
            alignas(64) typename Packet<width>::RayHit query;
            alignas(64) std::array<int, width> valid;
            for (int lane = 0; lane < width; ++lane) {
                valid[static_cast<std::size_t>(lane)] = first + lane < rays.count ? -1 : 0;
                set_lane(query.ray, lane, rays, std::min(first + lane, rays.count - 1));
                query.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
            }
            ask(Packet<width>::intersect, valid.data(), scene, query);
            for (int lane = 0; lane < width && first + lane < rays.count; ++lane) {
                keep(first + lane, query.hit.geomID[lane], query.ray.tfar[lane], query.hit.Ng_x[lane],
                     query.hit.Ng_y[lane], query.hit.Ng_z[lane]);
            }
        }
    }
}

template <int width>
void find_free(RTCScene scene, const Rays& rays, Lane& free) {
    if constexpr (width == 1) {
        for (int i = 0; i < rays.count; ++i) {
            RTCRay query;
            set_ray(query, rays, i);
            ask(rtcOccluded1, scene, query);
            free[static_cast<std::size_t>(i)] = query.tfar < 0 ? 0.0 : 1.0;
        }
    } else {
        for (int first = 0; first < rays.count; first += width) {
            alignas(64) typename Packet<width>::Ray query;
            alignas(64) std::array<int, width> valid;
            for (int lane = 0; lane < width; ++lane) {
                valid[static_cast<std::size_t>(lane)] = first + lane < rays.count ? -1 : 0;
                set_lane(query, lane, rays, std::min(first + lane, rays.count - 1));
            }
            ask(Packet<width>::occluded, valid.data(), scene, query);
            for (int lane = 0; lane < width && first + lane < rays.count; ++lane) {
                free[static_cast<std::size_t>(first + lane)] = query.tfar[lane] < 0 ? 0.0 : 1.0;
            }
        }
    }
}

// Moves rays to the points met, and makes normals of unit length against the rays. Points stand a nanometre off their
// facets, so that light does not meet the one that it leaves.
void land(const Lane& found, const Lane& distance, Rays& rays, Normals& normals) {
    int kept = 0;
    for (int i = 0; i < rays.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (found[k] == 0) {
            continue;
        }
        rays.copy(i, kept);
        const auto to = static_cast<std::size_t>(kept++);
        const double nx = normals.x[k], ny = normals.y[k], nz = normals.z[k];
        const double towards = rays.dx[to] * nx + rays.dy[to] * ny + rays.dz[to] * nz;
        const double scale = (towards < 0 ? 1 : -1) / std::sqrt(nx * nx + ny * ny + nz * nz);
        normals.x[to] = nx * scale;
        normals.y[to] = ny * scale;
        normals.z[to] = nz * scale;
        rays.x[to] += distance[k] * rays.dx[to] + 1e-6 * normals.x[to];
        rays.y[to] += distance[k] * rays.dy[to] + 1e-6 * normals.y[to];
        rays.z[to] += distance[k] * rays.dz[to] + 1e-6 * normals.z[to];
    }
    rays.count = kept;
}

// A thread and its share of the rays.
template <int width>
class Worker {
  public:
    Worker(const Chain& chain, RTCScene scene, int block, std::uint64_t seed)
        : chain_(chain), scene_(scene), block_(block), generator_(seed) {
        counts_.pixels.resize(static_cast<std::size_t>(chain.detector_columns) *
                              static_cast<std::size_t>(chain.detector_rows));
    }

    Counts run(std::uint64_t rays) {
        while (counts_.launched < rays) {
            const int count =
                static_cast<int>(std::min<std::uint64_t>(static_cast<std::uint64_t>(block_), rays - counts_.launched));
            launch(count);
            counts_.launched += static_cast<std::uint64_t>(count);
        }
        image();
        return std::move(counts_);
    }

  private:
    void launch(int count) {
        emit(chain_, generator_, count, rays_);
        pass_train(chain_.illumination, rays_);
        fly_to(chain_.top_distance, rays_);
        for (int i = 0; i < rays_.count; ++i) { // the specimen's frame: half a turn about x
            const auto k = static_cast<std::size_t>(i);
            rays_.y[k] = -rays_.y[k];
            rays_.z[k] = chain_.top;
            rays_.dy[k] = -rays_.dy[k];
            rays_.dz[k] = -rays_.dz[k];
        }
        counts_.arrived += static_cast<std::uint64_t>(rays_.count);
        find_hits<width>(scene_, rays_, found_, distance_, normals_);
        land(found_, distance_, rays_, normals_);
        counts_.met += static_cast<std::uint64_t>(rays_.count);
        for (int bounce = 1; rays_.count > 0; ++bounce) {
            scatter(chain_.g, generator_, rays_, normals_);
            if (bounce == chain_.max_bounces) {
                depart(nullptr);
                break;
            }
            find_hits<width>(scene_, rays_, found_, distance_, normals_);
            depart(&found_);
            land(found_, distance_, rays_, normals_);
        }
    }

    // Appends the rays that pass the gate to the survivors, except for those that meet the specimen again.
    void depart(const Lane* again) {
        for (int i = 0; i < rays_.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const double dz = rays_.dz[k];
            const double rise = chain_.top - rays_.z[k];
            const double gx =
                chain_.gate_position * (rays_.x[k] * dz + rays_.dx[k] * rise) + chain_.gate_slope * rays_.dx[k];
            const double gy =
                chain_.gate_position * (rays_.y[k] * dz + rays_.dy[k] * rise) + chain_.gate_slope * rays_.dy[k];
            const double limit = chain_.gate_radius * dz;
            if (dz <= 0 || gx * gx + gy * gy > limit * limit || (again && (*again)[k] > 0)) {
                continue;
            }
            counts_.gated += 1;
            if (survivors_.count == block_) {
                image();
            }
            const auto to = static_cast<std::size_t>(survivors_.count++);
            survivors_.x[to] = rays_.x[k];
            survivors_.y[to] = rays_.y[k];
            survivors_.z[to] = rays_.z[k];
            survivors_.dx[to] = rays_.dx[k];
            survivors_.dy[to] = rays_.dy[k];
            survivors_.dz[to] = dz;
        }
    }

    void image() {
        find_free<width>(scene_, survivors_, free_);
        survivors_.compact(free_);
        for (int i = 0; i < survivors_.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            survivors_.z[k] -= chain_.top + chain_.top_distance;
        }
        pass_train(chain_.imaging, survivors_);
        fly_to(chain_.detector_distance, survivors_);
        const double turn = chain_.inverted ? -1 : 1;
        const double columns_per_mm = chain_.detector_columns / (2 * chain_.detector_half_width);
        const double rows_per_mm = chain_.detector_rows / (2 * chain_.detector_half_height);
        for (int i = 0; i < survivors_.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const double column = (turn * survivors_.x[k] + chain_.detector_half_width) * columns_per_mm;
            const double row = (turn * survivors_.y[k] + chain_.detector_half_height) * rows_per_mm;
            if (column >= 0 && row >= 0 && column < chain_.detector_columns && row < chain_.detector_rows) {
                counts_.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(chain_.detector_columns) +
                               static_cast<std::size_t>(column)] += 1;
                counts_.detected += 1;
            }
        }
        survivors_.count = 0;
    }

    const Chain& chain_;
    RTCScene scene_;
    int block_;
    Generator generator_;
    Rays rays_, survivors_;
    Normals normals_;
    alignas(64) Lane found_, distance_, free_;
    Counts counts_;
};

template <int width>
Counts trace_with(const Chain& chain, RTCScene scene, const Settings& settings) {
    std::vector<Counts> shares(settings.threads);
    {
        std::vector<std::jthread> threads;
        for (unsigned thread = 0; thread < settings.threads; ++thread) {
            threads.emplace_back([&, thread] {
                const std::uint64_t first = settings.rays * thread / settings.threads;
                const std::uint64_t end = settings.rays * (thread + 1) / settings.threads;
                const auto worker = std::make_unique<Worker<width>>(chain, scene, settings.block,
                                                                    settings.seed * 0xD1342543DE82EF95u + thread);
                shares[thread] = worker->run(end - first);
            });
        }
    }
    Counts sum = std::move(shares[0]);
    for (unsigned thread = 1; thread < settings.threads; ++thread) {
        const Counts& share = shares[thread];
        std::ranges::transform(sum.pixels, share.pixels, sum.pixels.begin(), std::plus<>());
        sum.launched += share.launched;
        sum.arrived += share.arrived;
        sum.met += share.met;
        sum.gated += share.gated;
        sum.detected += share.detected;
    }
    return sum;
}

} // namespace

Specimen::Specimen(const Triangles& triangles) {
    const RTCDevice device = rtcNewDevice(nullptr);
    if (!device) {
        throw std::runtime_error("Embree does not start");
    }
    const RTCScene scene = rtcNewScene(device);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* points = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                           triangles.points.size() / 3);
    std::ranges::copy(triangles.points, static_cast<float*>(points));
    void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), triangles.corners.size() / 3);
    std::ranges::copy(triangles.corners, static_cast<std::uint32_t*>(corners));
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
        throw std::runtime_error("Embree does not take the specimen");
    }
    device_ = device;
    scene_ = scene;
}

Specimen::~Specimen() {
    rtcReleaseScene(static_cast<RTCScene>(scene_));
    rtcReleaseDevice(static_cast<RTCDevice>(device_));
}

Counts trace(const Chain& chain, const Specimen& specimen, const Settings& settings) {
    const auto scene = static_cast<RTCScene>(specimen.scene());
    switch (settings.packet) {
    case 1:
        return trace_with<1>(chain, scene, settings);
    case 8:
        return trace_with<8>(chain, scene, settings);
    case 16:
        return trace_with<16>(chain, scene, settings);
    }
    throw std::runtime_error("Embree takes 1, 8 or 16 rays at once");
}

} // namespace peer
