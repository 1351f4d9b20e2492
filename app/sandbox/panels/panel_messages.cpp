// What the program has to say.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include <imgui/imgui.h>

namespace plumb {

void messages_panel(PanelContext &context) {
    // The newest on top, where it is seen even if there are many.
    const std::vector<Message> &messages = context.session.messages().all();
    for (auto at = messages.rbegin(); at != messages.rend(); ++at) {
        const Message &message = *at;
        const Colour &colour = message.severity == Message::Severity::error     ? theme::error
                               : message.severity == Message::Severity::warning ? theme::warning
                                                                                : theme::text;
        ImGui::PushStyleColor(ImGuiCol_Text, colour);
        wrapped(message.text);
        ImGui::PopStyleColor();
    }
}

} // namespace plumb
