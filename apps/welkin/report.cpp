// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "welkin/core/param_range.h"
#include "welkin/scene/param_json.h"

namespace welkin::app {
namespace {

using Json = nlohmann::ordered_json;

Json bodyJson(const sky::Body& body) {
  return {{"azimuth_deg", body.azimuthDeg}, {"elevation_deg", body.elevationDeg}};
}

// Of those above the horizon.
Json planetsJson(const sky::Ephemeris& ephemeris) {
  Json planets = Json::array();
  for (const sky::Planet& planet : ephemeris.planets) {
    if (planet.body.elevationDeg <= 0.0) continue;
    Json j = {{"name", planet.name}, {"magnitude", planet.magnitude}};
    j.update(bodyJson(planet.body));
    planets.push_back(std::move(j));
  }
  return planets;
}

Json coverJson(const scene::LayerCover& c) {
  return {{"requested_oktas", c.requestedOktas}, {"delivered_oktas", c.deliveredOktas}};
}

std::string genusName(weather::Genus genus) {
  return std::string(kEnumNames<weather::Genus>[static_cast<std::size_t>(genus)]);
}

std::string techniqueName(scene::Technique technique) {
  if (technique == scene::Technique::kAuto) technique = scene::Technique::kVolume;
  return std::string(kEnumNames<scene::Technique>[static_cast<std::size_t>(technique)]);
}

Json layersJson(const scene::SkyState& state) {
  Json layers = Json::array();
  for (std::size_t i = 0; i < state.weather.layers.size(); ++i) {
    const weather::Layer& l = state.weather.layers[i];
    Json j = {{"genus", genusName(l.genus)},
              {"base_m", l.baseM},
              {"top_m", l.topM},
              {"base_assumed", l.baseAssumed},
              {"technique", techniqueName(scene::techniqueOf(state.scene, l))},
              {"extinction_per_m", l.extinctionPerM},
              {"wind_from_deg", l.windFromDeg},
              {"wind_speed_mps", l.windSpeedMps},
              {"rain_mm_per_h", l.rainMmPerH}};
    j.update(coverJson(i < state.cover.size() ? state.cover[i] : scene::LayerCover{l.oktas, 0.0}));
    layers.push_back(std::move(j));
  }
  return layers;
}

Json sheetsJson(const scene::SkyState& state) {
  Json sheets = Json::array();
  for (std::size_t i = 0; i < state.scene.sheets.size(); ++i) {
    const scene::Sheet& s = state.scene.sheets[i];
    Json j = {{"surface", kEnumNames<scene::SheetSurface>[static_cast<std::size_t>(s.surface)]},
              {"height_m", s.heightM}};
    if (i < state.sheetCover.size()) j.update(coverJson(state.sheetCover[i]));
    sheets.push_back(std::move(j));
  }
  return sheets;
}

}  // namespace

double peakRssMib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string reportJson(const RenderSettings& settings, const RenderReport& r) {
  const scene::SkyState& s = r.state;
  Json j;
  j["welkin"] = WELKIN_VERSION;
  j["output"] = settings.out;
  j["renderer"] = r.traced ? "reference" : "gpu";
  j["device"] = r.device;
  j["time"] = formatUtcTime(s.time);
  j["place"] = {{"latitude_deg", s.scene.place.latitudeDeg},
                {"longitude_deg", s.scene.place.longitudeDeg},
                {"altitude_m", s.scene.place.altitudeM}};
  j["seed"] = s.scene.seed;
  j["metar"] = s.scene.metar ? Json(*s.scene.metar) : Json();
  j["sun"] = bodyJson(s.ephemeris.sun);
  j["sun"]["obscuration"] = s.ephemeris.solarEclipse.obscuration;
  j["moon"] = bodyJson(s.ephemeris.moon);
  j["moon"]["illuminated_fraction"] = s.ephemeris.moonIlluminatedFraction;
  j["moon"]["umbral_magnitude"] = s.ephemeris.lunarEclipse.umbralMagnitude;
  j["moon"]["penumbral_magnitude"] = s.ephemeris.lunarEclipse.penumbralMagnitude;
  j["planets"] = planetsJson(s.ephemeris);
  j["heading_deg"] = s.headingDeg;
  j["visibility_m"] = s.weather.visibilityM;
  j["layers"] = layersJson(s);
  j["sheets"] = sheetsJson(s);
  j["sky_cover"] = coverJson(s.skyCover);
  j["notes"] = s.weather.notes;
  for (const std::string& warning : s.warnings) j["notes"].push_back(warning);
  j["exposure_ev"] = r.frames.empty() ? Json() : Json(r.frames.front().exposureEv);
  j["passes"] = Json::array();
  for (const render::PassTime& p : r.passes) j["passes"].push_back({{"name", p.name}, {"ms", p.ms}});
  if (settings.scene.output.frames > 1) {
    j["frames"] = Json::array();
    for (const FrameReport& f : r.frames) {
      Json frame = {{"time", formatUtcTime(f.time)}, {"exposure_ev", f.exposureEv}, {"ms", f.ms}};
      if (!f.path.empty()) frame["path"] = f.path;
      j["frames"].push_back(std::move(frame));
    }
  }
  if (r.traced) {
    const TraceReport& t = *r.traced;
    j["samples"] = t.samples;
    j["noise"] = t.noise;
    j["complete"] = t.complete;
    j["paths_per_second"] = t.pathsPerSecond;
    j["scattering_events"] = t.events;
    j["events_per_second"] = t.eventsPerSecond;
  }
  j["total_ms"] = r.totalMs;
  j["peak_rss_mib"] = peakRssMib();
  j["scene"] = Json::parse(scene::toJson(settings.scene));
  // A path or a report may hold bytes that are not UTF-8; they become U+FFFD.
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::map<std::string, std::string> pictureMetadata(const scene::SkyState& s, double exposureEv,
                                                   io::ImageFormat format) {
  const scene::Place& p = s.scene.place;
  std::map<std::string, std::string> m{
      {"Software", "welkin " WELKIN_VERSION},
      {kMeaningKey, io::holdsLuminance(format) ? "linear Rec. 709, cd/m2" : "sRGB"},
      {"welkin_time", formatUtcTime(s.time)},
      {"welkin_place",
       numberText(p.latitudeDeg) + "," + numberText(p.longitudeDeg) + "," + numberText(p.altitudeM)},
      {"welkin_seed", std::to_string(s.scene.seed)},
      {"welkin_projection",
       std::string(kEnumNames<scene::Projection>[static_cast<std::size_t>(s.scene.camera.projection)])},
      {"welkin_heading_deg", numberText(s.headingDeg)},
      {"welkin_exposure_ev", numberText(exposureEv)},
      {"welkin_sun_disc", s.scene.output.sunDisc ? "true" : "false"}};
  if (s.scene.metar) m.emplace("welkin_metar", *s.scene.metar);
  return m;
}

}  // namespace welkin::app
