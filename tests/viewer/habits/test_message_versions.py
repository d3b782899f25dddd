"""Which versions of messages are shown in which frames of the past."""

from tests.viewer.browser import Page, needs_browser

pytestmark = needs_browser

# What is shown in frames 0 to 6: a message is put at frame 1, replaced at 3 and removed at 5; another stays.
SHOWN = """async () => {
  const { MessageVersions } = await import("/time/message_versions.js");
  const versions = new MessageVersions();
  const message = (text) => ({ header: { text }, payload: new ArrayBuffer(0) });
  versions.put("stays", message("s"), 0);
  versions.put("goes", message("a"), 1);
  versions.put("goes", message("b"), 3);
  versions.remove("goes", 5);
  const at = (moment) => [...versions.at(moment).values()].map(({ message }) => message.header.text).join("");
  const shown = [0, 1, 2, 3, 4, 5, 6].map(at);
  versions.forget(4);
  return [shown, [4, 5].map(at), versions.newest("goes"), versions.newest("stays").header.text];
}"""


def test_a_message_is_shown_until_another_takes_its_place_or_it_is_removed(page: Page):
    shown, later, newest, stays = page.page.evaluate(SHOWN)
    assert shown == ["s", "sa", "sa", "sb", "sb", "s", "s"]
    assert later == ["sb", "s"]
    assert newest is None
    assert stays == "s"
