#!/bin/sh
# shard.sh I: one shard of a campaign. Called by campaign.sh, here or on another host.
set -u
bad=@bad@
# One has said that the campaign cannot be: the others need not.
[ ! -e "$bad" ] || exit 2
set -- @command@ --jobs 1 --shard "$1/@shards@"
@run_child@
case $code in
    0 | 3) exit 0 ;; # 3: a verdict failed, which is a result
    2) : >"$bad" ;;
esac
exit "$code"
