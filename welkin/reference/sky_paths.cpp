// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/sky_paths.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <coroutine>
#include <optional>
#include <utility>

#include "welkin/reference/cloud_walks.h"
#include "welkin/reference/directions.h"
#include "welkin/reference/sky_event.h"

namespace welkin::reference {
namespace {

// A path whose throughput is below the one goes on with a chance, and with the other.
constexpr double kRouletteBelow = 0.1, kRouletteTo = 0.3;
// Light of which a smaller share than this would leave towards the eye, 1/sr, is looked for with a chance:
// most scatterings in a cloud send little that way, and each would have its way to the sun walked.
constexpr double kLittleLight = 0.03;

double sum(const glm::dvec3& v) {
  return v.x + v.y + v.z;
}
double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

// What follows paths in one lane; it is resumed when the lane's walk has ended.
class Follower {
 public:
  struct promise_type {
    Follower get_return_object() {
      return Follower(std::coroutine_handle<promise_type>::from_promise(*this));
    }
    std::suspend_always initial_suspend() noexcept { return {}; }
    std::suspend_always final_suspend() noexcept { return {}; }
    void return_void() {}
    void unhandled_exception() { throw; }
  };

  Follower() = default;
  explicit Follower(std::coroutine_handle<promise_type> handle) : handle_(handle) {}
  Follower(Follower&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Follower& operator=(Follower&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Follower() {
    if (handle_) handle_.destroy();
  }
  void resume() { handle_.resume(); }

 private:
  std::coroutine_handle<promise_type> handle_;
};

// In a cloud, of layers or of metaballs.
struct Collision {
  double t = 0.0;  // along the ray
  const PhaseSampler* phase = nullptr;
  double albedo = 1.0;
};

class Paths {
 public:
  Paths(const TracedSky& sky, std::span<const PathStart> starts, std::span<SkySample> samples)
      : sky_(sky), starts_(starts), samples_(samples), walks_(sky.clouds) {}

  void trace() {
    std::array<Follower, CloudWalks::kLanes> followers;
    for (std::size_t lane = 0; lane < CloudWalks::kLanes; ++lane) followers[lane] = follow(lane);
    for (Follower& follower : followers) follower.resume();
    while (LaneBits ended = walks_.run())
      for (; ended != 0; ended &= ended - 1)
        followers[static_cast<std::size_t>(std::countr_zero(ended))].resume();
  }

 private:
  // The first collision before the ray leaves the air or meets the ground.
  struct Collide {
    Paths& paths;
    std::size_t lane;
    const Ray& ray;
    Random& random;
    bool await_ready() { return false; }
    void await_suspend(std::coroutine_handle<>) {
      paths.walks_.collide(lane, ray, CloudMedium::kToGround, random);
    }
    std::optional<Collision> await_resume() {
      const TracedSky& sky = paths.sky_;
      std::optional<Collision> collision;
      if (const auto c = paths.walks_.collision(lane)) collision = {c->t, &sky.phaseOf(c->matter), 1.0};
      if (sky.balls.empty()) return collision;
      if (const auto b = sky.balls.collide(ray, collision ? collision->t : sky.end(ray), random))
        collision = {b->t, &sky.phaseOf(b->phase), b->albedo};
      return collision;
    }
  };
  // What of light gets through all clouds.
  struct Transmit {
    Paths& paths;
    std::size_t lane;
    const Ray& ray;
    Random& random;
    bool await_ready() { return false; }
    void await_suspend(std::coroutine_handle<>) {
      paths.walks_.transmit(lane, ray, CloudMedium::kToGround, random);
    }
    double await_resume() {
      const TracedSky& sky = paths.sky_;
      const double through = paths.walks_.transmittance(lane);
      return through > 0.0 && !sky.balls.empty()
                 ? through * sky.balls.transmittance(ray, sky.end(ray), random)
                 : through;
    }
  };

  Follower follow(std::size_t lane);
  SkyEvent airEvent(SkyPath& path, double t, const glm::dvec3& weights, double chance, Random& random) const;

  const TracedSky& sky_;
  std::span<const PathStart> starts_;
  std::span<SkySample> samples_;
  CloudWalks walks_;
  std::size_t next_ = 0;
};

// Scattering somewhere in [0, t] of the path's ray, which was chosen with a chance.
SkyEvent Paths::airEvent(SkyPath& path, double t, const glm::dvec3& weights, double chance,
                         Random& random) const {
  const Air::Place place = sky_.air.samplePlace(sky_.earth, path.ray, t, weights, random);
  const glm::dvec3 p = path.ray.at(place.t);
  const Air::Medium m = sky_.air.at(sky_.earth.height(p));
  path.throughput *= sky_.throughAir(path.ray, place.t) * (m.rayleigh + m.aerosol) / (place.density * chance);
  return SkyEvent::inAir(sky_, path, p, m);
}

// Droplets scatter half of the light by a few degrees. A path that happens to point at the sun so closely
// finds a thousand times the usual, and pictures need as many paths as it takes for that to even out. So the
// phase function is taken for a sum of a peak and a rest that is nowhere large. Of the scatterings of a way
// of light from the sun to the eye, the last ones in a cloud that are by the peak make a chain; the event
// before them, by the rest, finds the light: straight where there is no chain, else along a chain drawn from
// the sun's side, whose directions follow the peaks one after the other, and which is walked towards the sun
// from collision to collision. Each way of light is found once, and none carries much. (R. Buras and B. Mayer
// 2011, "Efficient unbiased variance reduction techniques for Monte Carlo simulations of radiative transfer
// in cloudy atmospheres: The solution", has the problem and another cure.)
Follower Paths::follow(std::size_t lane) {
  const TracedSky& sky = sky_;
  while (next_ < starts_.size()) {
    const std::size_t index = next_++;
    const PathStart& start = starts_[index];
    SkySample sample;
    Random random(start.seed);
    const bool discs = sky.state.scene.output.sunDisc;
    SkyPath path{{{0.0, 0.0, sky.state.scene.camera.eyeM}, start.way}, glm::dvec3(1.0), true};
    std::optional<Collision> collision;

    // The first piece is followed twice: to a scattering in the air, and to what is behind it.
    struct Part {
      SkyPath path;
      SkyEvent event;
    };
    std::optional<Part> parts[2];
    {
      double near = 0.0, far = 0.0;
      glm::dvec3 onDisc(0.0);
      const bool down = sky.meetsGround(path.ray);
      if (discs && !down) onDisc = sky.lights.discs(start.way);
      if ((sky.starlight > 0.0f || sky.planets.count > 0) && start.pixelRad > 0.0f && !down)
        onDisc += sky.starsBeyond(start.way, discs, start.pixelRad);
      if (!sky.earth.crossings(path.ray, sky.air.topM(), near, far) || far <= 0.0) {
        sample.luminance = onDisc;
        samples_[index] = sample;
        continue;
      }
      if (near > 0.0) path.ray.from = path.ray.at(near);
      collision = co_await Collide{*this, lane, path.ray, random};
      sample.cloud = collision.has_value();
      const double t = collision ? collision->t : sky.end(path.ray);
      glm::dvec3 through(1.0);
      if (!sky.air.empty()) {
        through = sky.throughAir(path.ray, t);
        const double share = sum(1.0 - through) / 3.0;
        // Air that adds little is worth few paths.
        const double chance = std::min(1.0, 4.0 * share);
        if (share > 0.0 && unit(random) < chance) {
          SkyPath inAir{path.ray, glm::dvec3(1.0), false};
          const SkyEvent event = airEvent(inAir, t, glm::dvec3(1.0), chance, random);
          parts[0] = {inAir, event};
        }
      }
      path.throughput = through;
      const glm::dvec3 p = path.ray.at(t);
      if (collision) {
        path.throughput *= collision->albedo;
        parts[1] = {path, SkyEvent::inCloud(sky, path, p, *collision->phase)};
      } else if (sky.meetsGround(path.ray)) {
        path.throughput *= sky.groundAlbedo(p);
        parts[1] = {path, SkyEvent::onGround(sky, p)};
      } else {
        sample.luminance += through * (sky.above(path.ray) + onDisc);
      }
    }

    for (std::optional<Part>& part : parts) {
      if (!part || sum(part->path.throughput) <= 0.0) continue;
      path = part->path;
      SkyEvent event = part->event;
      for (;;) {
        ++sample.events;
        // Light that the event sends along the path: straight from sun or moon, and by way of a chain.
        const LightSample light = sky.lights.sample(event.place(), random);
        for (int way = 0; way < (light.disc < 0 ? 0 : 2); ++way) {
          glm::dvec3 at = event.place(), lit;
          if (way == 0) {
            lit = path.throughput * event.value(light.direction);
          } else {
            const double chance = event.chain();
            if (!sky.mayHaveCloud() || unit(random) >= chance) continue;
            PeakChain chain = drawPeaks(light.direction, sky.peak, random);
            lit = path.throughput * event.value(chain.ways[chain.count - 1]) * chain.weight / chance;
            while (chain.count > 0 && sum(lit) != 0.0) {
              const Ray ray{at, chain.ways[--chain.count]};
              collision = co_await Collide{*this, lane, ray, random};
              if (!collision || collision->phase != &sky.droplets) {  // no others have that peak
                lit = glm::dvec3(0.0);
                break;
              }
              ++sample.chained;
              lit *= collision->albedo * sky.throughAir(ray, collision->t);
              at = ray.at(collision->t);
            }
          }
          if (sum(lit) == 0.0 || sky.lights.isBelow(light, at)) continue;
          if (const double mean = sum(lit) / 3.0; sky.mayHaveCloud() && mean < kLittleLight) {
            if (unit(random) * kLittleLight >= mean) continue;
            lit *= kLittleLight / mean;
          }
          const Ray ray{at, light.direction};
          const double through = co_await Transmit{*this, lane, ray, random};
          if (through > 0.0) sample.luminance += lit * through * sky.lights.illuminance(light, at);
        }

        // On to the next.
        event.leave(path, random);
        const double most = largest(path.throughput);
        if (most < kRouletteBelow) {
          if (unit(random) * kRouletteTo >= most) break;
          path.throughput *= kRouletteTo / most;
        }
        collision = co_await Collide{*this, lane, path.ray, random};
        const double t = collision ? collision->t : sky.end(path.ray);
        if (!sky.air.empty()) {
          // One event of the two, each with the chance of its share of the light.
          const glm::dvec3 through = sky.throughAir(path.ray, t);
          const double chance = sum(path.throughput * (1.0 - through)) / sum(path.throughput);
          if (unit(random) < chance) {
            const glm::dvec3 weights = path.throughput;
            event = airEvent(path, t, weights, chance, random);
            continue;
          }
          path.throughput *= through / (1.0 - chance);
        }
        const glm::dvec3 p = path.ray.at(t);
        if (collision) {
          path.throughput *= collision->albedo;
          event = SkyEvent::inCloud(sky, path, p, *collision->phase);
        } else if (sky.meetsGround(path.ray)) {
          path.throughput *= sky.groundAlbedo(p);
          if (sum(path.throughput) <= 0.0) break;
          event = SkyEvent::onGround(sky, p);
        } else {
          sample.luminance += path.throughput * sky.above(path.ray);
          break;
        }
      }
    }
    samples_[index] = sample;
  }
}

}  // namespace

void tracePaths(const TracedSky& sky, std::span<const PathStart> starts, std::span<SkySample> samples) {
  Paths(sky, starts, samples).trace();
}

}  // namespace welkin::reference
