#include "coordinator/web/kept_pictures.h"

#include <iterator>
#include <string_view>
#include <utility>

namespace hyades::coordinator {
namespace {

constexpr size_t kMostKeptBytes = size_t{128} << 20U;
/// A picture of a frame in work is not made more often, however many samples have come.
constexpr std::chrono::milliseconds kFreshFor{1000};

/// Of an open job's tag all but the frame's version: the same until the job begins anew.
std::string_view life_of(std::string_view tag) { return tag.substr(0, tag.rfind('.')); }

}  // namespace

std::optional<WebReply> KeptPictures::find(const AskedPicture& asked, const std::string& tag,
                                           bool over) {
  const core::MutexLock lock(mutex_);
  const auto found = index_.find(asked);
  if (found == index_.end()) return std::nullopt;
  const Made& made = found->second->second;
  // A job that begins anew has nothing of before.
  const bool of_now = !over && !made.over && life_of(made.tag) == life_of(tag);
  const bool fresh = made.tag == tag || (of_now && Clock::now() - made.at < kFreshFor);
  if (!fresh) return std::nullopt;
  kept_.splice(kept_.begin(), kept_, found->second);
  return made.reply;
}

void KeptPictures::keep(const AskedPicture& asked, const std::string& tag, bool over,
                        const WebReply& reply) {
  if (reply.status != 200) return;
  const core::MutexLock lock(mutex_);
  if (const auto old = index_.find(asked); old != index_.end()) forget(old->second);
  kept_.emplace_front(asked, Made{tag, over, Clock::now(), reply});
  index_[asked] = kept_.begin();
  kept_bytes_ += reply.text->size();
  while (kept_bytes_ > kMostKeptBytes && kept_.size() > 1) forget(std::prev(kept_.end()));
}

void KeptPictures::forget(Kept::iterator one) {
  kept_bytes_ -= one->second.reply.text->size();
  index_.erase(one->first);
  kept_.erase(one);
}

WebReply KeptPictures::reply_for(const farm::ByteBudget::Owner& reader, WebReply reply,
                                 const WebReply& refused) const {
  if (reply.status != 200) return reply;
  if (!has_room(reader)) return refused;
  struct Counted {
    Counted(std::shared_ptr<farm::ByteBudget> of, const farm::ByteBudget::Owner& owner,
            std::shared_ptr<const std::string> bytes)
        : budget(std::move(of)), share(*budget, owner), text(std::move(bytes)) {
      share.hold(text->size());
    }
    std::shared_ptr<farm::ByteBudget> budget;
    farm::ByteBudget::Share share;
    std::shared_ptr<const std::string> text;
  };
  const auto counted = std::make_shared<Counted>(held_, reader, std::move(reply.text));
  reply.text = std::shared_ptr<const std::string>(counted, counted->text.get());
  reply.is_counted = true;
  return reply;
}

}  // namespace hyades::coordinator
