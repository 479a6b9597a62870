#include <memory>
#include <utility>

#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

/// A grey of one number of the input.
class ChannelTexture final : public Texture {
 public:
  ChannelTexture(TexturePtr input, Channel channel) : input_(std::move(input)), channel_(channel) {}

  Rgb color(const TexturePoint& at) const override {
    switch (channel_) {
      case Channel::alpha:
        return Rgb(input_->alpha(at));
      case Channel::luminance:
        return Rgb(input_->scalar(at));
      default:
        return Rgb(input_->color(at)[static_cast<int>(channel_)]);
    }
  }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    Vec4 inner(0.0F);
    if (channel_ == Channel::luminance) {
      inner = kLuminance;
    } else {
      inner[static_cast<int>(channel_)] = 1.0F;
    }
    const float of_grey = weights.x + weights.y + weights.z;
    ScalarGradient result = input_->gradient(at, of_grey * inner);
    result.value += weights.w;
    return result;
  }

 private:
  TexturePtr input_;
  Channel channel_;
};

}  // namespace

TexturePtr make_channel_texture(TexturePtr input, Channel channel) {
  return std::make_shared<ChannelTexture>(std::move(input), channel);
}

}  // namespace hyades::core
