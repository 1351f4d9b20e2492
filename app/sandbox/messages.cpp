#include "app/sandbox/messages.h"

#include <utility>

namespace plumb {

void Messages::say(Message::Severity severity, std::string text) {
    // A repeated message replaces the old one.
    std::erase_if(messages_, [&](const Message &m) { return m.text == text; });
    messages_.push_back({severity, std::move(text), 0});
    if (messages_.size() > most)
        messages_.erase(messages_.begin());
}

void Messages::grow_older(double seconds) {
    for (Message &message : messages_)
        message.age += seconds;
    std::erase_if(messages_, [](const Message &m) {
        return m.severity == Message::Severity::note && m.age > note_lifetime;
    });
}

} // namespace plumb
