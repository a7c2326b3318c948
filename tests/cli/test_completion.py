"""`calm completion`: what bash and zsh make of it, and that fish is given its own."""

import os
import shutil
import subprocess

import pexpect
import pytest

COMPLETES = """\
source calm.bash
COMP_WORDS=({words}); COMP_CWORD={last}; COMP_LINE='{words}'; COMP_POINT=${{#COMP_LINE}}
$(complete -p calm | sed 's/.*-F \\([^ ]*\\).*/\\1/')
echo "${{COMPREPLY[@]}}"
"""


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
@pytest.mark.parametrize(
    ("words", "offered"),
    [("calm ru", "run"), ("calm run --env", "--environment"), ("calm catalog sh", "show")],
)
def test_bash_completes_commands_and_options(calm, folder, words, offered):
    (folder / "calm.bash").write_text(calm("completion", "bash").out)
    script = COMPLETES.format(words=words, last=len(words.split()) - 1)
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == [offered]
    assert not done.stderr


READS = {
    "in a folder of fpath": "fpath=($PWD $fpath); autoload -Uz compinit; compinit -u -D",
    "sourced": "autoload -Uz compinit; compinit -u -D; source ./_calm",
}


@pytest.mark.thorough
@pytest.mark.skipif(shutil.which("zsh") is None, reason="needs zsh")
@pytest.mark.parametrize("reads", READS.values(), ids=READS)
def test_zsh_completes_commands_and_options(calm, folder, reads):
    (folder / "_calm").write_text(calm("completion", "zsh").out)
    shell = pexpect.spawn("zsh", ["-f", "-i"], env={**os.environ, "TERM": "dumb"}, timeout=20)
    shell.sendline(f"{reads}; print read''y")
    shell.expect_exact("ready")
    for typed, completed in (("calm ru", "calm run "), ("calm run --env", "--environment ")):
        shell.send(typed + "\t")
        shell.expect_exact(completed)
        shell.sendcontrol("u")
    shell.close(force=True)


def test_the_file_for_zsh_runs_the_function_of_its_name(calm):
    script = calm("completion", "zsh").out
    assert "\n_calm() {" in script
    assert "_cyclopts" not in script
    assert script.endswith('_calm "$@"; else compdef _calm calm; fi\n')


@pytest.mark.parametrize(("shell", "head"), [("zsh", "#compdef calm"), ("fish", "# Fish")])
def test_other_shells_have_a_script_of_their_own(calm, shell, head):
    done = calm("completion", shell)
    assert (done.code, done.err) == (0, "")
    assert done.out.startswith(head)
    assert "environment" in done.out


def test_a_shell_that_is_not_known(calm):
    done = calm("completion", "tcsh")
    assert (done.code, done.out) == (2, "")
    assert '"bash", "zsh", "fish"' in done.err
