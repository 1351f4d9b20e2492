// Messages to the user.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include <imgui/imgui.h>

namespace plumb {

void messages_panel(PanelContext &context) {
    // Newest on top, visible even if there are many.
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
