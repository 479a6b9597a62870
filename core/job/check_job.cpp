#include "core/job/check_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/base/udim.h"
#include "core/job/check_colors.h"
#include "core/job/check_frame.h"
#include "core/job/check_materials.h"
#include "core/job/frame_files.h"
#include "core/job/ocio_files.h"
#include "core/job/reference_graph.h"
#include "core/job/references.h"

namespace hyades::core {

namespace {

constexpr uint64_t kMostObjects = uint64_t{1} << 22;  ///< once all groups are unfolded
constexpr size_t kMostCandidates = 10'000;            ///< for 'did you mean'
constexpr int kMostFrames = 1000;                     ///< at which animated values are tried
constexpr size_t kMostChecks = 2'000'000;             ///< of animated values, short ones
constexpr size_t kShortExpression = 16;               ///< characters; longer ones count as several
/// Textures made of textures, materials of materials, groups of groups: readers of a job may use
/// recursion this deep (and about 20 groups written in place, see kMaxYamlDepth).
constexpr int kLongestChain = 32;
/// What one lookup of a texture or a material may cost: each use of another counts.
constexpr uint64_t kMostContributors = 4096;

template <class Desc>
std::vector<std::string> names_of(const std::vector<Desc>& list) {
  std::vector<std::string> names;
  for (const Desc& desc : list) names.push_back(desc.name);
  return names;
}

void check_names(ReadContext& context) {
  if (context.files_missing) return;
  static const char* const kNouns[] = {"texture", "material", "group", "object", "medium"};
  std::array<std::set<std::string>, 5> given;
  for (size_t i = 0; i < given.size(); ++i)
    given[i] = {context.given[i].begin(), context.given[i].end()};
  for (const NameUse& use : context.names) {
    const auto kind = static_cast<size_t>(use.kind);
    if (given[kind].contains(use.name)) continue;
    if (context.diagnostics.full()) return;
    const std::vector<std::string>& all = context.given[kind];
    const std::span<const std::string> names(all.data(), std::min(all.size(), kMostCandidates));
    std::string hint = did_you_mean(use.name, names);
    if (hint.empty() && names.empty()) {
      hint = "; the job defines none";
      if (use.kind == NameKind::texture)
        hint += ", and a colour is [r, g, b], \"#d8c8a8\" or 3200K";
    }
    if (hint.empty() && names.size() <= 12) hint = "; there are " + join_names(names);
    context.complain(use.where, fmt::format("{} names the {} '{}', which does not exist{}",
                                            use.label, kNouns[kind], use.name, hint));
  }
}

/// Complains about the first thing that is made of too many others, each counted as often as it is
/// used: chains need not be long to be endless in effect. True: there is none.
template <class Desc>
bool check_parts(ReadContext& context, const std::vector<Desc>& list, ReferenceGraph& graph,
                 const char* noun) {
  for (const Desc& desc : list) {
    if (graph.unfolded(desc.name) <= kMostContributors) continue;
    context.complain(desc.where, fmt::format("{} '{}' is made of more than {} others, each counted "
                                             "as often as it is used",
                                             noun, desc.name, kMostContributors));
    return false;
  }
  return true;
}

void check_texture_cycles(ReadContext& context) {
  const Job& job = context.job;
  ReferenceGraph graph(names_of(job.textures));
  for (size_t i = 0; i < job.textures.size(); ++i) {
    graph.weigh(i, 1);
    for (const std::string& name : names_in(job.textures[i], NameKind::texture)) graph.add(i, name);
  }
  const std::vector<size_t> cycles = graph.in_cycles();
  for (const size_t i : cycles) {
    context.complain(job.textures[i].where,
                     fmt::format("texture '{}' is made of itself", job.textures[i].name));
  }
  if (!cycles.empty()) return;
  if (const auto i = graph.first_longer_than(kLongestChain)) {
    context.complain(job.textures[*i].where,
                     fmt::format("texture '{}' is made of more than {} others in a row",
                                 job.textures[*i].name, kLongestChain));
    return;
  }
  check_parts(context, job.textures, graph, "texture");
}

/// True: no material is made of itself or of too many others.
bool check_material_cycles(ReadContext& context) {
  const Job& job = context.job;
  ReferenceGraph graph(names_of(job.materials));
  for (size_t i = 0; i < job.materials.size(); ++i) {
    graph.weigh(i, 1);
    for (const std::string& part : names_in(job.materials[i], NameKind::material)) {
      graph.add(i, part);
    }
  }
  const std::vector<size_t> cycles = graph.in_cycles();
  for (const size_t i : cycles) {
    context.complain(job.materials[i].where,
                     fmt::format("material '{}' is made of itself", job.materials[i].name));
  }
  if (!cycles.empty()) return false;
  if (const auto i = graph.first_longer_than(kLongestChain)) {
    context.complain(job.materials[*i].where,
                     fmt::format("material '{}' is made of more than {} others in a row",
                                 job.materials[*i].name, kLongestChain));
    return false;
  }
  return check_parts(context, job.materials, graph, "material");
}

/// Calls `visit` with the name of every group that `objects` place and how many groups written in
/// place are around it (itself included), and returns how many objects there are without those.
template <class Visit>
uint64_t visit_instances(const std::vector<ObjectDesc>& objects, const Visit& visit,
                         int depth = 1) {
  uint64_t count = 0;
  for (const ObjectDesc& object : objects) {
    if (object.shape == "instance") {
      visit(object.instance_of, depth);
    } else if (object.shape == "group") {
      count += visit_instances(object.children, visit, depth + 1);
    } else {
      ++count;
    }
  }
  return count;
}

void check_groups(ReadContext& context) {
  const Job& job = context.job;
  ReferenceGraph graph(names_of(job.groups));
  for (size_t i = 0; i < job.groups.size(); ++i) {
    const auto add = [&](const std::string& name, int depth) { graph.add(i, name, depth); };
    graph.weigh(i, visit_instances(job.groups[i].objects, add));
  }
  const std::vector<size_t> cycles = graph.in_cycles();
  for (const size_t i : cycles) {
    context.complain(job.groups[i].where,
                     fmt::format("group '{}' contains itself", job.groups[i].name));
  }
  if (!cycles.empty()) return;
  if (const auto i = graph.first_longer_than(kLongestChain)) {
    context.complain(job.groups[*i].where,
                     fmt::format("group '{}' has more than {} groups within each other",
                                 job.groups[*i].name, kLongestChain));
  }
  uint64_t total = 0;
  total += visit_instances(job.objects, [&](const std::string& name, int) {
    total = std::min(total + graph.unfolded(name), uint64_t{1} << 40);
  });
  if (total > kMostObjects) {
    context.complain({job.file, 0, 0},
                     fmt::format("the groups unfold to more than {} objects", kMostObjects));
  }
}

/// Whether a script (empty: the job itself, which may name every file) may name a file.
Status may_name(const std::string& script, const std::string& reference, AssetResolver& assets) {
  return script.empty() ? Status() : assets.may_name(script, reference);
}

/// Opens a file, or all files of a UDIM pattern or a sequence, so that whoever records
/// what a job opens knows them.
Status open_all(const FileUse& use, AssetResolver& assets, FileSequenceOpener& sequences) {
  const std::string& reference = use.reference;
  if (use.per_frame && is_file_sequence(reference)) {
    return sequences.open(reference, *use.per_frame);
  }
  std::vector<std::string> files = {reference};
  if (is_udim(reference)) {
    const auto tiles = udim_tiles(assets, reference);
    if (!tiles) return tiles.error();
    files.clear();
    for (const int tile : *tiles) files.push_back(udim_file(reference, tile));
  }
  for (const std::string& file : files) {
    if (const auto bytes = assets.open(file); !bytes) return bytes.error();
  }
  return {};
}

void check_files(ReadContext& context, AssetResolver& assets) {
  std::set<std::pair<std::string, std::string>> good;  // of scripts and files
  FileSequenceOpener sequences(context.job, assets);
  for (const FileUse& use : context.files) {
    if (good.contains({use.script, use.reference})) continue;
    const Status named = may_name(use.script, use.reference, assets);
    const Status opened = named ? open_all(use, assets, sequences) : named;
    if (opened) {
      good.insert({use.script, use.reference});
    } else {
      context.complain(use.where, fmt::format("{}: {}", use.label, opened.error().message));
    }
  }
}

/// Opens what the colour configuration names, so that it travels with the job. What is missing is
/// missed only by those displays that need it. Scripts bring none: OpenColorIO opens what it finds
/// named there, in more ways than are found here.
void find_color_files(ReadContext& context, AssetResolver& assets) {
  if (!context.job.color) return;
  ColorDesc& color = *context.job.color;
  const auto use =
      std::find_if(context.files.begin(), context.files.end(),
                   [&](const FileUse& file) { return file.reference == color.config; });
  if (use == context.files.end()) return;
  if (!use->script.empty()) {
    context.complain(use->where, use->label + " is named by the script " + use->script +
                                     ", expected it in the job that includes the script");
    return;
  }
  const auto config = assets.open(color.config);
  if (!config) return;  // complained about already
  for (const std::string& file : ocio_file_candidates({config->chars(), config->size()})) {
    const std::string reference = resolve_reference(file, color.config);
    if (assets.open(file, color.config)) color.files.push_back(reference);
  }
}

/// Up to kMostFrames of the job's frames, evenly spread, first and last included.
std::vector<int32_t> sample_frames(const FramesDesc& frames) {
  const int64_t count = (int64_t{frames.last} - frames.first) / frames.step + 1;
  const int64_t tried = std::min<int64_t>(count, kMostFrames);
  std::vector<int32_t> result;
  for (int64_t i = 0; i < tried; ++i) {
    const int64_t index = tried > 1 ? i * (count - 1) / (tried - 1) : 0;
    result.push_back(static_cast<int32_t>(frames.first + index * frames.step));
  }
  return result;
}

/// Complains about the first of `frames` at which each check fails.
template <class Check>
void check_values(ReadContext& context, const std::vector<Check>& checks,
                  const std::vector<int32_t>& frames, size_t stride) {
  for (const Check& check : checks) {
    for (size_t i = 0; i < frames.size(); i += stride) {
      if (const auto complaint = complaint_at(context.job, frames[i], check)) {
        context.complain(complaint->where, complaint->message);
        break;
      }
      if (is_constant(check)) break;
    }
  }
}

size_t cost_of(const Expression* expression) {
  return expression == nullptr ? 0 : expression->text().size() / kShortExpression;
}

template <class T>
size_t cost_of(const Animated<T>& value) {
  size_t cost = 0;
  for (const auto& expression : value.expressions) cost += cost_of(expression.get());
  return cost;
}

/// How many evaluations of short expressions it costs to try all of the checks once.
size_t cost_of(const ValueChecks& checks) {
  size_t cost = checks.numbers.size() + checks.vectors.size();
  for (const NumberCheck& check : checks.numbers) cost += cost_of(check.expression.get());
  for (const VectorCheck& check : checks.vectors) {
    cost += cost_of(check.value) + cost_of(check.other);
  }
  return cost;
}

void check_frames(ReadContext& context) {
  const ValueChecks& checks = context.job.checks;
  const std::vector<int32_t> frames = sample_frames(context.job.frames);
  // Bounded in all: very many checks are tried at fewer frames each.
  const size_t moments = context.job.frames.shutter > 0.0F ? kShutterMoments : 1;
  const size_t each_frame = cost_of(checks) * moments;
  const size_t stride = 1 + each_frame * frames.size() / kMostChecks;
  check_values(context, checks.numbers, frames, stride);
  check_values(context, checks.vectors, frames, stride);
}

/// Density varies from place to place of a body; all space has no bounds.
void check_atmosphere(ReadContext& context) {
  for (const MediumDesc& medium : context.job.media) {
    if (medium.name != context.job.atmosphere || !medium.varying) continue;
    context.complain(medium.where,
                     fmt::format("medium '{}' is the atmosphere and has a density that varies, "
                                 "expected it to be inside of an object",
                                 medium.name));
  }
}

}  // namespace

void check_job(ReadContext& context, AssetResolver& assets) {
  check_names(context);
  check_texture_cycles(context);
  if (check_material_cycles(context)) check_two_sided(context);
  check_emission(context);
  check_texture_colors(context);
  read_normal_maps_as_numbers(context);
  check_groups(context);
  check_atmosphere(context);
  check_files(context, assets);
  find_color_files(context, assets);
  check_frames(context);
}

}  // namespace hyades::core
