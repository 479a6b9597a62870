#include "jobs/generator/lamplighter.h"

#include <array>
#include <cmath>
#include <vector>

#include "core/scene/transforms.h"
#include "jobs/generator/glb_writer.h"
#include "jobs/generator/implicit.h"
#include "jobs/generator/shapes.h"
#include "jobs/generator/surface_nets.h"

namespace hyades::gallery {
namespace {

using nlohmann::json;

using core::kRadians;
constexpr float kTurn = 2.0F * core::kPi;

/// A joint at rest: where it is, where its bone ends, and what it hangs on.
struct Joint {
  const char* name;
  int parent;
  Vec3 at;
  Vec3 end;
};

enum : int {
  hips,
  spine,
  head,
  hat,
  thigh_l,
  shin_l,
  foot_l,
  thigh_r,
  shin_r,
  foot_r,
  arm_l,
  fore_l,
  hand_l,
  arm_r,
  fore_r,
  hand_r,
  tail,
  kJoints
};

const std::array<Joint, kJoints> kSkeleton = {{
    {"hips", -1, {0.0F, 0.40F, 0.0F}, {0.0F, 0.48F, 0.0F}},
    {"spine", hips, {0.0F, 0.50F, 0.0F}, {0.0F, 0.66F, 0.0F}},
    {"head", spine, {0.0F, 0.70F, 0.0F}, {0.0F, 0.84F, 0.02F}},
    {"hat", head, {0.0F, 0.92F, -0.01F}, {0.0F, 1.04F, -0.06F}},
    {"thigh_l", hips, {0.085F, 0.37F, 0.0F}, {0.09F, 0.22F, 0.015F}},
    {"shin_l", thigh_l, {0.09F, 0.21F, 0.015F}, {0.095F, 0.08F, -0.005F}},
    {"foot_l", shin_l, {0.095F, 0.06F, -0.005F}, {0.105F, 0.035F, 0.09F}},
    {"thigh_r", hips, {-0.085F, 0.37F, 0.0F}, {-0.09F, 0.22F, 0.015F}},
    {"shin_r", thigh_r, {-0.09F, 0.21F, 0.015F}, {-0.095F, 0.08F, -0.005F}},
    {"foot_r", shin_r, {-0.095F, 0.06F, -0.005F}, {-0.105F, 0.035F, 0.09F}},
    {"arm_l", spine, {0.15F, 0.63F, 0.0F}, {0.23F, 0.53F, 0.0F}},
    {"fore_l", arm_l, {0.235F, 0.525F, 0.0F}, {0.275F, 0.42F, 0.02F}},
    {"hand_l", fore_l, {0.28F, 0.41F, 0.02F}, {0.29F, 0.36F, 0.03F}},
    {"arm_r", spine, {-0.15F, 0.63F, 0.0F}, {-0.23F, 0.54F, 0.02F}},
    {"fore_r", arm_r, {-0.235F, 0.535F, 0.02F}, {-0.26F, 0.47F, 0.13F}},
    {"hand_r", fore_r, {-0.262F, 0.468F, 0.14F}, {-0.265F, 0.46F, 0.19F}},
    {"tail", hips, {0.0F, 0.40F, -0.12F}, {0.0F, 0.44F, -0.26F}},
}};

float distance_to_body(const Vec3& p) {
  Body body(p);
  body.add({0.0F, 0.50F, 0.0F}, {0.155F, 0.175F, 0.14F});                          // belly
  body.add({0.0F, 0.60F, 0.0F}, {0.0F, 0.66F, 0.0F}, 0.12F, 0.085F, 0.05F);        // breast
  body.add({0.0F, 0.82F, 0.015F}, {0.15F, 0.135F, 0.135F}, 0.03F);                 // head
  body.add({0.0F, 0.795F, 0.15F}, {0.035F, 0.03F, 0.035F}, 0.03F);                 // nose
  body.add({0.0F, 0.93F, -0.005F}, {0.0F, 1.02F, -0.05F}, 0.085F, 0.02F, 0.015F);  // cap
  body.add({0.0F, 0.92F, -0.005F}, {0.125F, 0.022F, 0.125F}, 0.01F);               // its brim
  body.add({0.0F, 1.03F, -0.06F}, {0.028F, 0.028F, 0.028F}, 0.006F);               // its bobble
  body.add({0.0F, 0.42F, -0.1F}, {0.0F, 0.45F, -0.23F}, 0.05F, 0.035F, 0.04F);     // tail
  for (const float side : {-1.0F, 1.0F}) {
    body.add({side * 0.145F, 0.83F, 0.0F}, {0.025F, 0.045F, 0.035F}, 0.015F);  // ear
    body.add({side * 0.085F, 0.38F, 0.0F}, {side * 0.09F, 0.21F, 0.015F}, 0.085F, 0.062F, 0.04F);
    body.add({side * 0.09F, 0.21F, 0.015F}, {side * 0.095F, 0.06F, -0.005F}, 0.062F, 0.05F, 0.02F);
    body.add({side * 0.1F, 0.04F, 0.035F}, {0.06F, 0.042F, 0.095F}, 0.03F);  // boot
  }
  for (const int first : {int{arm_l}, int{arm_r}}) {
    const auto joint = [&](int i) { return kSkeleton[static_cast<size_t>(first + i)]; };
    body.add(joint(0).at, joint(0).end, 0.052F, 0.044F, 0.03F);
    body.add(joint(1).at, joint(1).end, 0.044F, 0.038F, 0.015F);
    body.add(joint(2).at, joint(2).end, 0.042F, 0.04F, 0.015F);
  }
  return body.distance();
}

/// Skin of felt, a darker coat, boots and cap: linear colours, by where a point is at rest.
Vec3 color_of(const Vec3& p) {
  const Vec3 skin(0.62F, 0.36F, 0.22F), coat(0.05F, 0.16F, 0.24F), boots(0.07F, 0.035F, 0.02F);
  const Vec3 cap(0.42F, 0.045F, 0.03F), bobble(0.75F, 0.70F, 0.6F), trousers(0.16F, 0.13F, 0.10F);
  if (p.y > 1.005F) return bobble;
  if (p.y > 0.895F) return cap;
  if (p.y > 0.69F) return skin;
  const bool hand = std::abs(p.x) > 0.23F && (p.y < 0.425F || p.z > 0.125F);
  if (hand) return skin;
  if (p.z < -0.15F) return bobble;
  if (p.y < 0.085F) return boots;
  if (p.y < 0.37F && std::abs(p.x) < 0.2F) return trousers;
  return coat;
}

float distance_to_bone(const Vec3& p, const Joint& joint) {
  return std::max(limb(p, joint.at, joint.end, 0.0F, 0.0F), 1e-4F);
}

/// The four joints that hold a point most, and their shares in 255ths.
struct Hold {
  std::array<uint8_t, 4> joints{};
  std::array<uint8_t, 4> shares{};
};

Hold hold_of(const Vec3& p) {
  std::array<std::pair<float, uint8_t>, kJoints> near;
  for (size_t i = 0; i < near.size(); ++i) {
    // The other side's limbs do not pull.
    const bool across = kSkeleton[i].at.x * p.x < 0.0F && std::abs(p.x) > 0.01F;
    const float d = distance_to_bone(p, kSkeleton[i]) * (across ? 8.0F : 1.0F);
    near[i] = {1.0F / std::pow(d, 5.0F), static_cast<uint8_t>(i)};
  }
  std::partial_sort(near.begin(), near.begin() + 4, near.end(), std::greater<>());
  float sum = 0.0F;
  for (size_t i = 0; i < 4; ++i) sum += near[i].first;
  Hold hold;
  int left = 255;
  for (size_t i = 3; i < 4; --i) {
    const int share = i == 0 ? left : static_cast<int>(255.0F * near[i].first / sum + 0.5F);
    hold.joints[i] = near[i].second;
    hold.shares[i] = static_cast<uint8_t>(share);
    left -= share;
  }
  return hold;
}

using Quaternion = std::array<float, 4>;

Quaternion about(const Vec3& axis, float degrees) {
  const float half = 0.5F * degrees * kRadians;
  const Vec3 v = axis * std::sin(half);
  return {v.x, v.y, v.z, std::cos(half)};
}

const Vec3 kX(1.0F, 0.0F, 0.0F), kY(0.0F, 1.0F, 0.0F), kZ(0.0F, 0.0F, 1.0F);

/// An animation being written: keys at even times.
class Clip {
 public:
  Clip(GlbWriter& out, const char* name, float seconds, int keys)
      : out_(out), seconds_(seconds), keys_(keys), clip_({{"name", name}}) {
    std::vector<float> times;
    for (int i = 0; i < keys; ++i) times.push_back(place(i) * seconds_);
    times_ = out_.floats(times, 1);
  }

  /// `turn(u)` for u from 0 to 1.
  template <class Turn>
  void rotate(int node, const Turn& turn) {
    std::vector<float> values;
    for (int i = 0; i < keys_; ++i) {
      const Quaternion q = turn(place(i));
      values.insert(values.end(), q.begin(), q.end());
    }
    channel(node, "rotation", out_.floats(values, 4));
  }

  template <class Move>
  void translate(int node, const Move& move) {
    std::vector<float> values;
    for (int i = 0; i < keys_; ++i) {
      const Vec3 v = move(place(i));
      values.insert(values.end(), {v.x, v.y, v.z});
    }
    channel(node, "translation", out_.floats(values, 3));
  }

  template <class Share>
  void weigh(int node, const Share& share) {
    std::vector<float> values;
    for (int i = 0; i < keys_; ++i) values.push_back(share(place(i)));
    channel(node, "weights", out_.floats(values, 1));
  }

  void end() { out_.add("animations", clip_); }

 private:
  float place(int key) const { return static_cast<float>(key) / static_cast<float>(keys_ - 1); }

  void channel(int node, const char* path, int values) {
    clip_["samplers"].push_back(
        {{"input", times_}, {"output", values}, {"interpolation", "LINEAR"}});
    const size_t sampler = clip_["samplers"].size() - 1;
    clip_["channels"].push_back(
        {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
  }

  GlbWriter& out_;
  float seconds_;
  int keys_;
  int times_ = 0;
  json clip_;
};

Vec3 offset_of(int joint) {
  const Joint& own = kSkeleton[static_cast<size_t>(joint)];
  return own.parent < 0 ? own.at : own.at - kSkeleton[static_cast<size_t>(own.parent)].at;
}

/// Shut for a moment around u = 0.62.
float blink(float u) { return std::max(0.0F, 1.0F - std::abs(u - 0.62F) / 0.06F); }

void add_walk(GlbWriter& out, const std::array<int, 2>& eyes, int lantern) {
  Clip clip(out, "Walk", 1.0F, 25);
  const auto leg = [&](int thigh, float phase) {
    clip.rotate(thigh,
                [=](float u) { return about(kX, -28.0F * std::sin(kTurn * (u + phase)) - 4.0F); });
    // The knee bends while the leg swings forward.
    clip.rotate(thigh + 1, [=](float u) {
      return about(kX, 8.0F + 44.0F * std::max(0.0F, std::cos(kTurn * (u + phase + 0.03F))));
    });
    clip.rotate(thigh + 2,
                [=](float u) { return about(kX, 14.0F * std::sin(kTurn * (u + phase)) - 6.0F); });
  };
  leg(thigh_l, 0.0F);
  leg(thigh_r, 0.5F);
  clip.translate(hips, [](float u) {
    return offset_of(hips) +
           Vec3(0.012F * std::sin(kTurn * u), 0.016F * std::cos(2.0F * kTurn * u) - 0.012F, 0.0F);
  });
  clip.rotate(hips, [](float u) { return about(kY, 8.0F * std::sin(kTurn * u)); });
  clip.rotate(spine, [](float u) { return about(kZ, 4.0F * std::sin(kTurn * u)); });
  clip.rotate(head, [](float u) { return about(kZ, -5.0F * std::sin(kTurn * (u - 0.08F))); });
  clip.rotate(
      hat, [](float u) { return about(kX, 12.0F * std::sin(2.0F * kTurn * (u - 0.1F)) - 6.0F); });
  clip.rotate(tail, [](float u) { return about(kY, 28.0F * std::sin(kTurn * (u - 0.15F))); });
  clip.rotate(arm_l, [](float u) { return about(kX, 34.0F * std::sin(kTurn * u)); });
  clip.rotate(fore_l, [](float u) { return about(kX, -24.0F + 12.0F * std::sin(kTurn * u)); });
  clip.rotate(arm_r, [](float u) { return about(kX, -18.0F - 7.0F * std::sin(kTurn * u)); });
  clip.rotate(lantern, [](float u) { return about(kX, 9.0F * std::sin(kTurn * (u - 0.2F))); });
  for (const int eye : eyes) clip.weigh(eye, blink);
  clip.end();
}

void add_wave(GlbWriter& out, const std::array<int, 2>& eyes) {
  Clip clip(out, "Wave", 2.0F, 49);
  const auto raised = [](float u) { return std::max(0.0F, std::sin(0.5F * kTurn * u)); };
  clip.rotate(arm_l, [=](float u) { return about(kZ, 115.0F * std::sqrt(raised(u))); });
  clip.rotate(fore_l, [=](float u) {
    return about(kZ, raised(u) * (20.0F + 26.0F * std::sin(4.0F * kTurn * u)));
  });
  clip.rotate(head, [=](float u) { return about(kZ, -9.0F * raised(u)); });
  clip.rotate(tail, [](float u) { return about(kY, 30.0F * std::sin(4.0F * kTurn * u)); });
  for (const int eye : eyes) clip.weigh(eye, blink);
  clip.end();
}

int add_materials(GlbWriter& out) {
  const auto plain = [](const char* name, std::array<float, 3> color, float roughness,
                        float metallic) {
    return json{{"name", name},
                {"pbrMetallicRoughness",
                 {{"baseColorFactor", {color[0], color[1], color[2], 1.0F}},
                  {"roughnessFactor", roughness},
                  {"metallicFactor", metallic}}}};
  };
  json felt = plain("Felt", {1.0F, 1.0F, 1.0F}, 0.85F, 0.0F);
  felt["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {0.35F, 0.3F, 0.28F}},
                                               {"sheenRoughnessFactor", 0.5F}};
  json eye = plain("Eye", {0.012F, 0.01F, 0.01F}, 0.08F, 0.0F);
  json brass = plain("Brass", {0.78F, 0.52F, 0.2F}, 0.28F, 1.0F);
  json flame = plain("Flame", {0.0F, 0.0F, 0.0F}, 1.0F, 0.0F);
  flame["emissiveFactor"] = {1.0F, 0.55F, 0.2F};
  flame["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 90.0F}};
  json pane = plain("Pane", {1.0F, 0.93F, 0.8F}, 0.0F, 0.0F);
  pane["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1.0F}};
  const int first = out.add("materials", felt);
  for (const json& material : {eye, brass, flame, pane}) out.add("materials", material);
  out.json["extensionsUsed"] = {"KHR_materials_sheen", "KHR_materials_emissive_strength",
                                "KHR_materials_transmission"};
  return first;
}

int add_body(GlbWriter& out, int material) {
  const Mesh mesh =
      make_surface({{-0.36F, -0.03F, -0.32F}, {0.36F, 1.1F, 0.28F}, 0.0135F}, distance_to_body);
  std::vector<uint8_t> joints, shares, colors;
  for (const Vec3& p : mesh.positions) {
    const Hold hold = hold_of(p);
    joints.insert(joints.end(), hold.joints.begin(), hold.joints.end());
    shares.insert(shares.end(), hold.shares.begin(), hold.shares.end());
    const Vec3 color = color_of(p);
    for (const float c : {color.x, color.y, color.z, 1.0F}) {
      colors.push_back(static_cast<uint8_t>(255.0F * c + 0.5F));
    }
  }
  json primitive = {{"material", material}, {"indices", out.indices(mesh.triangles)}};
  primitive["attributes"] = {{"POSITION", out.positions(mesh.positions)},
                             {"NORMAL", out.positions(mesh.normals)},
                             {"COLOR_0", out.bytes(colors, true)},
                             {"JOINTS_0", out.bytes(joints, false)},
                             {"WEIGHTS_0", out.bytes(shares, true)}};
  return out.add("meshes", {{"name", "Body"}, {"primitives", {primitive}}});
}

/// Ball that a morph target presses flat.
int add_eye(GlbWriter& out, int material) {
  constexpr float kRadius = 0.021F;
  std::vector<Vec2> arc;
  for (int i = 0; i <= 12; ++i) {
    const float a = 0.5F * kTurn * (static_cast<float>(i) / 12.0F - 0.5F);
    arc.emplace_back(kRadius * std::max(std::cos(a), 0.0F), kRadius * std::sin(a));
  }
  const Mesh ball = make_lathe(arc, 1, 24);
  std::vector<Vec3> shut;
  for (const Vec3& p : ball.positions) shut.emplace_back(0.0F, -0.88F * p.y, 0.0F);
  json primitive = {{"material", material}, {"indices", out.indices(ball.triangles)}};
  primitive["attributes"] = {{"POSITION", out.positions(ball.positions)},
                             {"NORMAL", out.positions(ball.normals)}};
  primitive["targets"] = {{{"POSITION", out.positions(shut)}}};
  return out.add("meshes", {{"name", "Eye"}, {"primitives", {primitive}}, {"weights", {0.0F}}});
}

json part(GlbWriter& out, const Mesh& mesh, int material) {
  json primitive = {{"material", material}, {"indices", out.indices(mesh.triangles)}};
  primitive["attributes"] = {{"POSITION", out.positions(mesh.positions)},
                             {"NORMAL", out.positions(mesh.normals)}};
  return primitive;
}

/// A lantern that hangs from its origin: brass above and below a pane, a flame within.
int add_lantern(GlbWriter& out, int brass) {
  const Mesh top = make_lathe({{0.0F, -0.075F},
                               {0.05F, -0.075F},
                               {0.052F, -0.07F},
                               {0.03F, -0.045F},
                               {0.012F, -0.03F},
                               {0.007F, 0.0F},
                               {0.0F, 0.0F}},
                              4, 32);
  const Mesh base = make_lathe(
      {{0.0F, -0.19F}, {0.05F, -0.19F}, {0.053F, -0.183F}, {0.05F, -0.172F}, {0.0F, -0.17F}}, 4,
      32);
  const Mesh pane = make_lathe({{0.0F, -0.17F},
                                {0.03F, -0.169F},
                                {0.043F, -0.15F},
                                {0.045F, -0.12F},
                                {0.04F, -0.085F},
                                {0.03F, -0.076F},
                                {0.0F, -0.075F}},
                               4, 32);
  const Mesh flame = make_lathe(
      {{0.0F, -0.155F}, {0.01F, -0.148F}, {0.013F, -0.135F}, {0.008F, -0.115F}, {0.0F, -0.1F}}, 4,
      20);
  const json primitives = {part(out, top, brass), part(out, base, brass),
                           part(out, flame, brass + 1), part(out, pane, brass + 2)};
  return out.add("meshes", {{"name", "Lantern"}, {"primitives", primitives}});
}

void add_joints(GlbWriter& out) {
  for (int i = 0; i < kJoints; ++i) {
    const Vec3 offset = offset_of(i);
    json node = {{"name", kSkeleton[static_cast<size_t>(i)].name},
                 {"translation", {offset.x, offset.y, offset.z}}};
    for (int child = 0; child < kJoints; ++child) {
      if (kSkeleton[static_cast<size_t>(child)].parent == i) node["children"].push_back(child);
    }
    out.add("nodes", node);
  }
}

int add_skin(GlbWriter& out) {
  std::vector<float> inverse;
  std::vector<int> joints;
  for (int i = 0; i < kJoints; ++i) {
    const Vec3& at = kSkeleton[static_cast<size_t>(i)].at;
    const float matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -at.x, -at.y, -at.z, 1};
    inverse.insert(inverse.end(), matrix, matrix + 16);
    joints.push_back(i);
  }
  return out.add(
      "skins",
      {{"inverseBindMatrices", out.floats(inverse, 16)}, {"joints", joints}, {"skeleton", hips}});
}

}  // namespace

std::string make_lamplighter() {
  GlbWriter out;
  const int felt = add_materials(out);
  add_joints(out);
  const int skin = add_skin(out);
  const int body =
      out.add("nodes", {{"name", "Body"}, {"mesh", add_body(out, felt)}, {"skin", skin}});
  const int eye_mesh = add_eye(out, felt + 1);
  std::array<int, 2> eyes{};
  for (size_t i = 0; i < 2; ++i) {
    const float side = i == 0 ? 1.0F : -1.0F;
    eyes[i] = out.add("nodes", {{"name", i == 0 ? "eye_l" : "eye_r"},
                                {"mesh", eye_mesh},
                                {"translation", {side * 0.055F, 0.135F, 0.132F}}});
    out.json["nodes"][head]["children"].push_back(eyes[i]);
  }
  const int lantern = out.add("nodes", {{"name", "lantern"},
                                        {"mesh", add_lantern(out, felt + 2)},
                                        {"translation", {0.0F, -0.035F, 0.04F}}});
  out.json["nodes"][hand_r]["children"].push_back(lantern);
  add_walk(out, eyes, lantern);
  add_wave(out, eyes);
  out.json["scenes"] = {{{"nodes", {hips, body}}}};
  out.json["scene"] = 0;
  return out.file();
}

}  // namespace hyades::gallery
