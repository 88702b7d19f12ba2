#include "apps/run/run_options.h"
#include "apps/run/whole_number.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <type_traits>

namespace patchlight {

namespace {

template <class O, class Options>
concept IsA = std::is_same_v<std::remove_const_t<O>, Options>;

// The options' members, each named once for both directions. Structured bindings: with a member more or less this no
// longer compiles, so that none is forgotten.

template <IsA<MeshingOptions> O>
void fields(O& o, auto&& field)
{
    auto& [max_edge, min_angle, max_elements] = o;
    field("max_edge", max_edge);
    field("min_angle", min_angle);
    field("max_elements", max_elements);
}

template <IsA<FormFactorOptions> O>
void fields(O& o, auto&& field)
{
    auto& [method, directions, rays, shadow_rays, small_source, resolution, tolerance, seed] = o;
    field("method", method, form_factor_method_names());
    field("directions", directions, direction_names());
    field("rays", rays);
    field("resolution", resolution);
    field("shadow_rays", shadow_rays);
    field("small_source", small_source);
    field("tolerance", tolerance);
    field("seed", seed);
}

template <IsA<SolveOptions> O>
void fields(O& o, auto&& field)
{
    auto& [solver, tolerance, max_sweeps, order, ambient, overshoot] = o;
    field("solver", solver, solver_names());
    field("tolerance", tolerance);
    field("max_sweeps", max_sweeps);
    field("order", order, order_names());
    field("ambient", ambient);
    field("overshoot", overshoot);
}

template <IsA<GatherOptions> O>
void fields(O& o, auto&& field)
{
    auto& [rays, shadow_rays, small_source, crease_angle, seed] = o;
    field("rays", rays);
    field("shadow_rays", shadow_rays);
    field("small_source", small_source);
    field("crease_angle", crease_angle);
    field("seed", seed);
}

template <IsA<EstimateOptions> O>
void fields(O& o, auto&& field)
{
    auto& [indicator, rays] = o;
    field("indicator", indicator, indicator_names());
    field("rays", rays);
}

template <IsA<MarkOptions> O>
void fields(O& o, auto&& field)
{
    auto& [marking, share, least, smallest, local] = o;
    field("marking", marking, marking_names());
    field("share", share);
    field("least", least);
    field("smallest", smallest);
    field("local", local);
}

template <IsA<LineOptions> O>
void fields(O& o, auto&& field)
{
    auto& [least_saving, secondary_share, most_secondary] = o;
    field("least_saving", least_saving);
    field("secondary_share", secondary_share);
    field("most_secondary", most_secondary);
}

template <IsA<AdaptiveOptions> O>
void fields(O& o, auto&& field)
{
    auto& [meshing, mesh, form_factors, final, gather, estimate, mark, lines, refine, elements, direct, iterations,
           target_error, max_elements, looked_at] = o;
    field("refine", refine, refine_names());
    field("elements", elements, element_names());
    field("direct", direct, direct_names());
    field("iterations", iterations);
    field("target_error", target_error);
    field("max_elements", max_elements);
    field("meshing", meshing);
    field("form_factors", form_factors);
    field("final", final);
    field("gather", gather);
    field("estimate", estimate);
    field("mark", mark);
    field("lines", lines);
}

template <class O>
concept HasFields = requires(O& o)
{
    fields(o, [](auto&&...) {});
};

struct Written {
    Json json = Json::object();

    template <class T>
    void operator()(const char* name, const T& value)
    {
        if constexpr (HasFields<const T>) {
            Written inner;
            fields(value, inner);
            json[name] = std::move(inner.json);
        } else {
            json[name] = value;
        }
    }
    template <class Mode>
    void operator()(const char* name, Mode mode, const ModeNames<Mode>& names)
    {
        json[name] = name_of(names, mode);
    }
};

struct Reader {
    const Json& json;

    template <class T>
    void operator()(const char* name, T& value) const
    {
        const Json& found = json.at(name);
        if constexpr (HasFields<T>) {
            fields(value, Reader{found});
        } else if constexpr (std::is_same_v<T, bool>) {
            value = found.get<bool>();
        } else {
            try {
                if constexpr (std::is_integral_v<T>) {
                    value = whole_number_in<T>(found);
                } else {
                    value = found.get<T>();
                }
            } catch (const std::exception& problem) {
                throw std::invalid_argument(fmt::format("\"{}\": {}", name, problem.what()));
            }
        }
    }
    template <class Mode>
    void operator()(const char* name, Mode& mode, const ModeNames<Mode>& names) const
    {
        mode = mode_of(names, json.at(name).get<std::string>());
    }
};

template <class Read>
auto reading(const Read& read)
{
    try {
        return read();
    } catch (const nlohmann::json::exception& error) {
        throw SceneError("run", std::string("its options can't be read: ") + error.what());
    } catch (const std::invalid_argument& error) {
        throw SceneError("run", std::string("its options can't be read: ") + error.what());
    }
}

Vec3 vector_in(const Json& json)
{
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

}  // namespace

Json json_of(const AdaptiveOptions& options)
{
    Written written;
    fields(options, written);
    return written.json;
}

AdaptiveOptions adaptive_options_in(const Json& json)
{
    return reading([&] {
        AdaptiveOptions options;
        fields(options, Reader{json});
        return options;
    });
}

Json json_of(const SceneOptions& o)
{
    Json emitters = Json::object();
    for (const auto& [name, value] : o.emitters) {
        emitters[name] = json_of(value);
    }
    return {{"unit", o.unit},           {"max_reflectance", o.max_reflectance},
            {"snap", o.snap},           {"all_two_sided", o.all_two_sided},
            {"two_sided", o.two_sided}, {"emitters", emitters}};
}

SceneOptions scene_options_in(const Json& json)
{
    return reading([&] {
        SceneOptions o;
        o.unit = json.at("unit").get<double>();
        o.max_reflectance = json.at("max_reflectance").get<double>();
        o.snap = json.at("snap").get<double>();
        o.all_two_sided = json.at("all_two_sided").get<bool>();
        o.two_sided = json.at("two_sided").get<std::vector<std::string>>();
        for (const auto& [name, value] : json.at("emitters").items()) {
            o.emitters[name] = vector_in(value);
        }
        return o;
    });
}

View view_in(const Json& json)
{
    return reading([&] {
        return View{json.at("name").get<std::string>(),    vector_in(json.at("from")),
                    vector_in(json.at("forward")),         vector_in(json.at("up")),
                    json.at("vertical_fov").get<double>(), json.value("aspect", 0.0)};
    });
}

}  // namespace patchlight
