//! Folders of runs: taken, cleared and continued.

use super::*;

fn write(path: PathBuf) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, "x").unwrap();
}

#[test]
fn a_used_folder_is_refused_and_force_clears_only_a_run() {
    let comm = Comm::solo();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deep/run");
    let mut run = RunFolder::at(&path);
    run.take_new(&comm, false, false).unwrap();
    run.create(&comm, "title = 1", false).unwrap();
    assert_eq!(run.status().unwrap().state, Phase::Running);
    let refused = run.create(&comm, "", false).unwrap_err();
    let in_use = matches!(refused, OutputError::FolderInUse { .. });
    assert!(in_use && refused.to_string().contains("--force"));

    let ours = |path: PathBuf| {
        run.list(&path).unwrap();
        write(path);
    };
    ours(run.snapshot(3));
    ours(run.series());
    run.list_checkpoint(3).unwrap();
    run.list_checkpoint(4).unwrap();
    write(run.checkpoints().join("step-00000003/manifest.json"));
    write(run.checkpoints().join("step-00000003.damaged/state.h5"));
    write(run.checkpoints().join("step-00000004.partial/state.h5"));
    ours(run.snapshot_of(Some("close"), 3));
    ours(run.series_of(Some("close")));
    ours(run.snapshot_of(Some("far"), 3));
    ours(run.post_mortem(3).with_extension("txt"));
    write(path.join("set-aside/1/snapshots/step-00000003.vtkhdf"));
    // A user's, also under names that a run might write.
    let others = [
        "checkpoints/step-00000003/notes.txt",
        "checkpoints/step-00000007/manifest.json",
        "notes.txt",
        "set-aside/1/notes.txt",
        "snapshots/far/my picture.png",
        "snapshots/my picture.png",
        "snapshots/step-00000009.vtkhdf",
        "trouble/notes.txt",
    ];
    for name in others {
        write(path.join(name));
    }
    // What is not in the folder, but seems so through a link.
    let elsewhere = folder.path().join("elsewhere");
    write(elsewhere.join("step-00000005.csv"));
    run.list(&run.fragment_table(5)).unwrap();
    std::os::unix::fs::symlink(&elsewhere, run.fragment_tables()).unwrap();

    let told = run.create(&comm, "title = 2", true).unwrap().unwrap();
    assert!(
        told.contains("keeps what the run did not write: "),
        "{told}"
    );
    assert!(told.ends_with("and 4 more"), "{told}");
    let mut left = Vec::new();
    find(&path, &mut left);
    left.retain(|file| {
        !["case.toml", "files.txt", "lock", "status.json"]
            .iter()
            .any(|own| *file == path.join(own))
    });
    left.sort();
    let mut expected = others.map(|name| path.join(name)).to_vec();
    expected.push(run.fragment_tables());
    expected.sort();
    assert_eq!(left, expected);
    assert!(elsewhere.join("step-00000005.csv").exists());
    let case = fs::read_to_string(run.case()).unwrap();
    assert_eq!(case, format!("# run {}\ntitle = 2", run.id().unwrap()));
}

/// The files and links in a folder and in those in it.
fn find(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in names_in(folder).unwrap() {
        if path.is_dir() && !path.is_symlink() {
            find(&path, found);
        } else {
            found.push(path);
        }
    }
}

#[test]
fn force_leaves_a_folder_alone_that_holds_no_run() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    write(case.clone());
    let refused = RunFolder::at(folder.path())
        .create(&Comm::solo(), "", true)
        .unwrap_err();
    assert!(matches!(refused, OutputError::NotARun { .. }));
    assert_eq!(fs::read_to_string(case).unwrap(), "x");
    // Many programs have a status.
    write(folder.path().join("status.json"));
    let refused = RunFolder::at(folder.path())
        .create(&Comm::solo(), "", true)
        .unwrap_err();
    assert!(matches!(refused, OutputError::NotARun { .. }));
}

#[test]
fn a_restart_sets_aside_what_came_after_its_checkpoint() {
    let comm = Comm::solo();
    let folder = tempfile::tempdir().unwrap();
    let mut run = RunFolder::at(folder.path());
    run.create(&comm, "", false).unwrap();
    let begun = run.clone();
    let write = |path: PathBuf| {
        begun.list(&path).unwrap();
        write(path);
    };
    for step in [2, 4, 6] {
        write(run.snapshot(step));
        let time = f64::from(u32::try_from(step).unwrap());
        write(run.snapshot_of(Some("close"), step));
        for series in [run.series(), run.series_of(Some("close"))] {
            series::add(&series, &RunFolder::snapshot_name(step), time).unwrap();
        }
        write(
            run.checkpoints()
                .join(format!("step-{step:08}/manifest.json")),
        );
    }
    write(run.history());
    let names = |run: &RunFolder| {
        let checkpoints = run.checkpoint_folders().unwrap();
        let close = run.snapshot_files_of(Some("close")).unwrap();
        (run.snapshot_files().unwrap(), close, checkpoints)
    };
    let before = names(&run);
    // As a run of an earlier version has none.
    fs::remove_file(run.listing()).unwrap();
    let resume = |run: &mut RunFolder, passed_over: &[PathBuf]| {
        let aside = run.resume(&comm, Some("edited"), 4, 4.0, false, passed_over);
        aside.unwrap().unwrap()
    };
    // A restart that could not begin leaves the folder as it was.
    let aside = resume(&mut run, &[]);
    fs::remove_file(run.history()).unwrap();
    aside.undo();
    assert_eq!(names(&run), before);
    assert_eq!(series::read(&run.series()).unwrap().len(), 3);
    assert_eq!(run.status().unwrap().step, 0);
    let case = fs::read_to_string(run.case()).unwrap();
    assert!(case.ends_with('\n') && case.lines().count() == 1);
    assert_eq!(fs::read_to_string(run.history()).unwrap(), "x");
    assert_eq!(run.set_aside_folder(), None);

    let damaged = run.checkpoints().join("step-00000006");
    drop(resume(&mut run, std::slice::from_ref(&damaged)));
    let [there] = &checkpoint::list_damaged(&run.checkpoints()).unwrap()[..] else {
        panic!()
    };
    assert!(there.ends_with("step-00000006.damaged") && !damaged.exists());
    let aside = run.set_aside_folder().unwrap().join("1");
    assert!(aside.join("snapshots/step-00000006.vtkhdf").exists());
    assert!(aside.join("history.csv").exists());
    // One more that makes no checkpoint overwrites nothing.
    write(run.snapshot(6));
    drop(resume(&mut run, &[]));
    let again = run.set_aside_folder().unwrap().join("2");
    assert!(aside.exists() && again.join("snapshots/step-00000006.vtkhdf").exists());
    run.forget_set_aside().unwrap();
    assert_eq!(run.set_aside_folder(), None);
    assert_eq!(
        run.snapshot_files().unwrap(),
        [run.snapshot(2), run.snapshot(4)]
    );
    assert_eq!(series::read(&run.series()).unwrap().len(), 2);
    let close = run.snapshot_files_of(Some("close")).unwrap();
    assert_eq!(
        close,
        [2, 4].map(|step| run.snapshot_of(Some("close"), step))
    );
    let close = run.series_of(Some("close"));
    assert!(close.ends_with("snapshots/close/close.vtkhdf.series"));
    assert_eq!(series::read(&close).unwrap().len(), 2);
    assert_eq!(run.schedules().unwrap(), ["close"]);
    let newest = run.checkpoint_folders().unwrap().remove(0);
    assert!(newest.ends_with("step-00000004"));
    assert_eq!(
        RunFolder::of_checkpoint(&newest)
            .unwrap()
            .status()
            .unwrap()
            .step,
        4
    );
}
